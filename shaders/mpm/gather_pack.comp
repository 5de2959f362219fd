// Particles in sorted order, packed for reading: (position in the cell, in cells; mass), (velocity, stress xx),
// (stress yy, zz, xy, xz); stress yz by itself.
#include "lib/blocks.glsl"

void main() {
  uint slot = element_index();
  if (slot >= particles_count) return;
  int particle = int(order_at(int(slot)));
  vec3 x = position_at(particle);
  mat3 s = stress_at(particle);
  packed_particles[3u * slot] = vec4(grid_coordinates(x) - vec3(cell_of(x)), mass_at(particle));
  packed_particles[3u * slot + 1u] = vec4(velocity_at(particle), s[0][0]);
  packed_particles[3u * slot + 2u] = vec4(s[1][1], s[2][2], s[0][1], s[0][2]);
  packed_stress[slot] = s[1][2];
}
