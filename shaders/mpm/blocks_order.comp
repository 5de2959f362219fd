// Sorting by block and cell, 6 of 6: particles of one cell by ascending number, so that sums over them repeat to the bit.
void main() {
  uint slot = element_index();
  if (slot >= particles_count) return;
  uint particle = unordered[slot];
  uint cell = particle_cell[particle] + (particle_cell[particle] >> 6u);
  uint first = block_cells[cell], end = block_cells[cell + 1u];
  uint smaller = 0u;
  uint other = first;
  do smaller += unordered[other] < particle ? 1u : 0u; while (++other < end);
  order[first + smaller] = particle;
}
