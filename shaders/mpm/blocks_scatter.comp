// Sorting by block and cell, 5 of 6: particles into their cells.
void main() {
  uint particle = element_index();
  if (particle >= particles_count) return;
  uint cell = particle_cell[particle];
  unordered[block_cells[cell + (cell >> 6u)] + particle_rank[particle]] = particle;
}
