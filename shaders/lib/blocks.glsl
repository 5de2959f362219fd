// The stored part of the grid: blocks of 4 x 4 x 4 nodes that particles reach. Block (i, j, k) holds the nodes from 4 (i, j, k) on, and the
// particles of the cells from 4 (i, j, k) - 2 on: these particles reach the nodes of this block and of those one below, in every axis, and
// no others.
#include "lib/grid.glsl"

ivec3 block_counts() { return grid_nodes / 4 + 1; }

uint block_number(ivec3 block) {
  ivec3 blocks = block_counts();
  return uint(block.x) + uint(blocks.x) * (uint(block.y) + uint(blocks.y) * uint(block.z));
}

ivec3 block_of(uint number) {
  uvec3 blocks = uvec3(block_counts());
  return ivec3(number % blocks.x, number / blocks.x % blocks.y, number / (blocks.x * blocks.y));
}

// The block that keeps a cell's particles, and which of its 64 cells it is.
ivec3 block_of_cell(ivec3 cell) { return (cell + 2) / 4; }
uint local_cell(ivec3 cell) {
  uvec3 inside = uvec3(cell + 2) & 3u;
  return inside.x + 4u * inside.y + 16u * inside.z;
}

uvec3 local_node(uint local) { return uvec3(local & 3u, local >> 2u & 3u, local >> 4u); }

// Which of `count` blocks a work group has. Software renderers give each thread a run of groups one after another; neighbouring blocks, of much
// the same weight, go to different threads.
uint spread(uint group, uint count) {
  uint run = count / 8u;
  return group < 8u * run ? 8u * (group % run) + group / run : group;
}
