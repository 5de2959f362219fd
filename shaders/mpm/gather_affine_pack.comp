// Particles in sorted order, packed for reading: (position in the block in cells, mass), then m v and the columns of -h A, A the affine
// momentum with the impulse of the stress in it: A = m C - dt (4/h^2) V0 tau. Positions keep all their bits: a rounding that is one-sided on
// average would move momentum at every step.
#include "lib/blocks.glsl"

void main() {
  uint slot = element_index();
  if (slot >= particles_count) return;
  int particle = int(order_at(int(slot)));
  vec3 x = position_at(particle);
  float m = mass_at(particle);
  mat3 a = (4.0 * dt / grid_cell) * stress_at(particle) - (m * grid_cell) * velocity_gradient_at(particle);
  ivec3 lowest = 4 * block_of_cell(cell_of(x)) - 2;
  packed_affine[4u * slot] = vec4(grid_coordinates(x) - vec3(lowest), m);
  packed_affine[4u * slot + 1u] = vec4(m * velocity_at(particle), a[0].x);
  packed_affine[4u * slot + 2u] = vec4(a[0].yz, a[1].xy);
  packed_affine[4u * slot + 3u] = vec4(a[1].z, a[2]);
}
