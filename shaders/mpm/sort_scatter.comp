// Counting sort by cell, 5 of 6: particles into their cells.
void main() {
  uint particle = element_index();
  if (particle >= particles_count) return;
  unordered[cell_start[particle_cell[particle]] + particle_rank[particle]] = particle;
}
