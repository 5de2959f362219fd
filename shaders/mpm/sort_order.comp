// Counting sort by cell, 6 of 6: particles of one cell by ascending number, so that sums over them repeat to the bit.
void main() {
  uint slot = element_index();
  if (slot >= particles_count) return;
  uint particle = unordered[slot];
  uint cell = particle_cell[particle];
  uint first = cell_start[cell], end = cell_start[cell + 1u];
  uint smaller = 0u;
  for (uint other = first; other < end; ++other) smaller += unordered[other] < particle ? 1u : 0u;
  order[first + smaller] = particle;
}
