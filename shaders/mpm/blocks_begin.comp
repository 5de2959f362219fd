// Sorting by block and cell, 1 of 6: the blocks of the last step leave the table.
void main() {
  uint slot = element_index();
  if (slot < active_block_count[0]) block_key[block_entry[slot]] = 0u;
}
