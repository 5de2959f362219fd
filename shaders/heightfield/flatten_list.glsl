#include "lib/cells.glsl"

#define TILE_LIST flatten_tiles
#define TILE_COUNT flatten_count
#include "lib/tile_list.glsl"

const uint tile_listed = 2u;  // in changed_tiles, while the list is made
