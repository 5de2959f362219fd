// The cell of this invocation. CELLS_ALL: one invocation per cell of the field. CELLS_ACTIVE: one group of 256 per tile in active_tiles, or
// in the list that OWN_TILES names. False where there is none.
#include "lib/cells.glsl"

#ifndef OWN_TILES
#define OWN_TILES active_tiles
#endif

bool own_cell(out ivec2 cell) {
#if CELLS_ACTIVE
  cell = ivec2(0);
  if (group_number() >= tiles_count) return false;
  uint tile = OWN_TILES[group_number()];
  if (tile == no_tile) return false;
  cell = tile_cell(tile);
  return in_field(cell);
#else
  uint index = element_index();
  cell = cell_at(min(index, cells_count - 1u));
  return index < cells_count;
#endif
}
