// The cells of this invocation, one above another along z. CELLS_ALL: one cell. CELLS_ACTIVE: one group of 32 per tile in active_tiles, or in
// the list that OWN_TILES names, and half a tile's edge for each. False where there is none; the last may lie beyond the field.
#include "lib/cells.glsl"

#ifndef OWN_TILES
#define OWN_TILES active_tiles
#endif

#if CELLS_ACTIVE
const int column_cells = tile_edge / 2;
#else
const int column_cells = 1;
#endif

bool own_column(out ivec2 first) {
#if CELLS_ACTIVE
  first = ivec2(0);
  uint tile = group_number() < tiles_count ? OWN_TILES[group_number()] : no_tile;
  if (tile == no_tile) return false;
  int lane = int(gl_LocalInvocationID.x);
  first = tile_edge * divided(int(tile), tile_counts().x) + ivec2(lane % tile_edge, lane / tile_edge * column_cells);
  return true;
#else
  uint index = element_index();
  first = cell_at(min(index, cells_count - 1u));
  return index < cells_count;
#endif
}
