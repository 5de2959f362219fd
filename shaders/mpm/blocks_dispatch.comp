// The size of dispatches over active blocks, one group each, folded into two axes; the counter is ready for the next list.
void main() {
  if (element_index() > 0u) return;
  uint count = block_counter[0];
  block_counter[0] = 0u;
  active_block_count[0] = count;
  active_groups[0] = min(count, 32768u);
  active_groups[1] = (count + 32767u) / 32768u;
  active_groups[2] = 1u;
}
