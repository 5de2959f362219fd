// Sorting by block and cell, 4 of 6: where every cell's particles start, block by block; blocks follow one another in no particular order.
// And the blocks about every block.
#include "lib/block_table.glsl"

int slot_of(ivec3 block) {
  int entry = entry_of(block);
  return entry < 0 ? 0 : int(block_slot[entry]);
}

void main() {
  uint slot = element_index();
  if (slot >= active_block_count[0]) return;
  uint entry = block_entry[slot];
  uint total = 0u;
  for (uint cell = 0u; cell < 64u; ++cell) total += cell_count[64u * entry + cell];
  uint start = atomicAdd(particle_counter[0], total);
  for (uint cell = 0u; cell < 64u; ++cell) {
    block_cells[65u * entry + cell] = start;
    start += cell_count[64u * entry + cell];
    cell_count[64u * entry + cell] = 0u;  // for the next sort
  }
  block_cells[65u * entry + 64u] = start;

  ivec3 block = block_of(active_blocks[slot]);
  for (int x = 0; x < 2; ++x) {
    ivec4 above, below;
    for (int i = 0; i < 4; ++i) {
      ivec3 corner = ivec3(x, i & 1, i >> 1);
      above[i] = entry_of(block + corner);
      below[i] = slot_of(block + corner - 1);
    }
    block_near[4u * slot + uint(x)] = above;
    block_near[4u * slot + 2u + uint(x)] = below;
  }
}
