// Sorting by block and cell, 3 of 6: sizes of dispatches over blocks, folded into two axes; counters are ready for the next step.
void main() {
  if (element_index() > 0u) return;
  uint count = block_counter[0];
  if (count > grid_blocks_count) {
    fault(FAULT_OVERFLOW);
    count = grid_blocks_count;
  }
  block_counter[0] = 0u;
  particle_counter[0] = 0u;
  active_block_count[0] = count;
  active_groups[0] = min(count, 32768u);
  active_groups[1] = (count + 32767u) / 32768u;
  active_groups[2] = 1u;
  block_groups[0] = (count + 63u) / 64u;
  block_groups[1] = 1u;
  block_groups[2] = 1u;
}
