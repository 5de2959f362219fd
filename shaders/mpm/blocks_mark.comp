// Blocks of 4 x 4 x 4 nodes that particles reach: the first particle of every cell marks the blocks of the nodes -1..+2 about its cell.
#include "lib/blocks.glsl"

void main() {
  uint slot = element_index();
  if (slot >= particles_count) return;
  ivec3 cell = cell_of(position[order[slot]]);
  if (cell_start[node_index(cell)] != slot) return;
  ivec3 low = (cell - 1) / 4, high = (cell + 2) / 4;
  ivec3 blocks = block_counts();
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) block_mark[x + blocks.x * (y + blocks.y * z)] = 1u;
}
