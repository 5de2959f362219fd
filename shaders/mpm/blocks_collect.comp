// Marked blocks into a list, in no particular order.
void main() {
  uint block = element_index();
  if (block >= grid_blocks_count || block_mark[block] == 0u) return;
  block_mark[block] = 0u;
  active_blocks[atomicAdd(block_counter[0], 1u)] = block;
}
