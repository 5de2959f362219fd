// Particles in sorted order, packed for reading: (position, stress yz), (velocity, stress xx), (stress yy, zz, xy, xz); mass apart.
void main() {
  uint slot = element_index();
  if (slot >= particles_count) return;
  uint particle = order[slot];
  mat3 s = stress[particle];
  packed_state[3u * slot] = vec4(position[particle], s[1][2]);
  packed_state[3u * slot + 1u] = vec4(velocity[particle], s[0][0]);
  packed_state[3u * slot + 2u] = vec4(s[1][1], s[2][2], s[0][1], s[0][2]);
  packed_mass[slot] = mass[particle];
}
