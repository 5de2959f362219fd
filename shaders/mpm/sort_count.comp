// Counting sort by cell, 2 of 6: how many particles lie in every cell and row; each takes a place in its cell, in no particular order.
#include "lib/grid.glsl"

void main() {
  uint particle = element_index();
  if (particle >= particles_count) return;
  uint cell = uint(node_index(cell_of(position[particle])));
  particle_cell[particle] = cell;
  particle_rank[particle] = atomicAdd(cell_count[cell], 1u);
  atomicAdd(row_count[cell / uint(grid_nodes.x)], 1u);
}
