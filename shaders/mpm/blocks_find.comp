// Sorting by block and cell, 2 of 6: every particle finds its block in the table and takes a place in its cell, in no particular order.
// Who is first in a block enters the seven below it, which particles of it may reach.
#include "lib/block_table.glsl"

// The entry of a block, which is made where there is none yet; `key` as it was found.
uint entered(ivec3 block, out uint key) {
  uint number = block_number(block), entry = first_entry(number);
  key = 0u;
  for (uint probes = 0u; probes < block_table_count; ++probes) {
    key = block_key[entry];
    if (key == 0u) key = atomicCompSwap(block_key[entry], 0u, number + 1u);
    if (key == 0u || (key & ~OCCUPIED) == number + 1u) break;
    entry = next_entry(entry);
  }
  if (key == 0u) {
    uint slot = atomicAdd(block_counter[0], 1u);
    block_slot[entry] = min(slot, grid_blocks_count - 1u);
    if (slot < grid_blocks_count) {
      active_blocks[slot] = number;
      block_entry[slot] = entry;
    }
  }
  return entry;
}

void main() {
  uint particle = element_index();
  if (particle >= particles_count) return;
  ivec3 cell = cell_of(position_at(int(particle)));
  ivec3 block = block_of_cell(cell);
  uint key, other;
  uint entry = entered(block, key);
  if ((key & OCCUPIED) == 0u) key = atomicOr(block_key[entry], OCCUPIED);
  if ((key & OCCUPIED) == 0u)
    for (uint below = 1u; below < 8u; ++below) {
      ivec3 lower = block - ivec3(below & 1u, below >> 1u & 1u, below >> 2u);
      if (all(greaterThanEqual(lower, ivec3(0)))) entered(lower, other);
    }
  uint counted = 64u * entry + local_cell(cell);
  particle_cell[particle] = counted;
  particle_rank[particle] = atomicAdd(cell_count[counted], 1u);
}
