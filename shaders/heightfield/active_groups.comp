#include "lib/cell_tiles.glsl"

#define TILE_LIST active_tiles
#define TILE_COUNT active_tile_count
#define TILE_GROUPS active_tile_groups
#include "lib/tile_list.glsl"

void main() { size_tile_groups(); }
