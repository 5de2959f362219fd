// Blocks of 4 x 4 x 4 nodes.
#include "lib/grid.glsl"

ivec3 block_counts() { return (grid_nodes + 3) / 4; }

ivec3 block_node(uint block, uint local) {
  ivec3 blocks = block_counts();
  ivec3 corner = 4 * ivec3(block % uint(blocks.x), block / uint(blocks.x) % uint(blocks.y), block / uint(blocks.x * blocks.y));
  return corner + ivec3(local & 3u, local >> 2u & 3u, local >> 4u);
}
