// Open addressing with linear probing: block_key holds number + 1, 0 where free, and whether particles lie in the block. Entries are never
// moved and leave all at once, so that a search may stop at the first free one.
#include "lib/blocks.glsl"

const uint OCCUPIED = 0x80000000u;

uint first_entry(uint number) {
  number ^= number >> 15u;
  number *= 0x2c1b3c6du;
  number ^= number >> 12u;
  return number & (block_table_count - 1u);
}
uint next_entry(uint entry) { return (entry + 1u) & (block_table_count - 1u); }

// The entry of a block, -1 where it has none.
int entry_of(ivec3 block) {
  if (any(lessThan(block, ivec3(0))) || any(greaterThanEqual(block, block_counts()))) return -1;
  uint number = block_number(block);
  uint entry = first_entry(number);
  for (uint probes = 0u; probes < block_table_count; ++probes, entry = next_entry(entry)) {
    uint key = block_key[entry];
    if ((key & ~OCCUPIED) == number + 1u) return int(entry);
    if (key == 0u) return -1;
  }
  return -1;
}
