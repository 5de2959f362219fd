// Tiles that this pass works on: those where something changed, which are listed, and their neighbours, which it may reach. A single group.
#define TILE_GROUPS flatten_groups
#include "heightfield/flatten_list.glsl"

void list_neighbor(ivec2 tile) {
  ivec2 counts = tile_counts();
  if (any(lessThan(tile, ivec2(0))) || any(greaterThanEqual(tile, counts))) return;
  uint index = uint(tile.y * counts.x + tile.x);
  if (atomicExchange(changed_tiles[index], tile_listed) == 0u) list_tile(index);
}

void main() {
  uint lane = gl_LocalInvocationID.x, changed = min(flatten_count[0], tiles_count);
  barrier();
  uint entry = lane;
  if (entry < changed) do {
    int tile = int(flatten_tiles[entry]), width = tile_counts().x;
#define LIST(n) list_neighbor(ivec2(tile % width, tile / width) + neighbor_offsets[n]);
    FOR_NEIGHBORS(LIST)
    entry += gl_WorkGroupSize.x;
  } while (entry < changed);
  memoryBarrierBuffer();
  barrier();
  uint all = min(flatten_count[0], tiles_count);
  for (entry = lane; entry < all; entry += gl_WorkGroupSize.x) changed_tiles[flatten_tiles[entry]] = 0u;
  size_tile_groups();
  if (lane > 0u) return;
  moved_bits[0] = 0u;
  moved[0] = 0.0;
}
