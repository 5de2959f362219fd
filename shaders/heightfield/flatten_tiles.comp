// Tiles that this pass works on: those where something changed, and their neighbours, which it may reach. A single group.
#include "lib/cells.glsl"

bool listed(uint tile) {
  ivec2 counts = tile_counts(), at = ivec2(int(tile) % counts.x, int(tile) / counts.x);
  ivec2 low = max(at - 1, ivec2(0)), high = min(at + 1, counts - 1);
  for (int z = low.y; z <= high.y; ++z)
    for (int x = low.x; x <= high.x; ++x)
      if (changed_tiles[z * counts.x + x] != 0u) return true;
  return false;
}

#define TILE_LIST flatten_tiles
#define TILE_GROUPS flatten_groups
#include "lib/tile_list.glsl"

void main() {
  list_tiles();
  barrier();
  for (uint tile = gl_LocalInvocationID.x; tile < tiles_count; tile += gl_WorkGroupSize.x) changed_tiles[tile] = 0u;
  if (gl_LocalInvocationID.x == 0u) {
    moved_bits[0] = 0u;
    moved[0] = 0.0;
  }
}
