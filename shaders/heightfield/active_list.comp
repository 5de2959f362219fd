// Tiles under bodies in this step or the last one, so that what the last step left there is undone; all of them in the first step.
#include "lib/cell_tiles.glsl"

#define TILE_LIST active_tiles
#define TILE_COUNT active_tile_count
#include "lib/tile_list.glsl"

void main() {
  uint tile = element_index();
  if (tile < tiles_count && (step == 0u || tile_stamp[tile] >= step + 1u)) list_tile(tile);
}
