// Tiles under bodies in this step or the last one, so that what the last step left there is undone; all of them in the first step. A
// single group.
#include "lib/cells.glsl"

bool listed(uint tile) { return step == 0u || tile_stamp[tile] >= step + 1u; }

#define TILE_LIST active_tiles
#define TILE_GROUPS active_tile_groups
#include "lib/tile_list.glsl"

void main() { list_tiles(); }
