// v_i = (m v)_i / m_i and v_i* = v_i + dt (f_i / m_i + g) [M 3.4 step 4]; nodes without mass stay at rest.
#if ACCUMULATE_FIXED
#include "lib/force_scale.glsl"
#endif

void main() {
  uint i = element_index();
  if (i >= nodes_count) return;
#if ACCUMULATE_FIXED
  float mass_here = float(grid_mass_sum[i]) / mass_scale;
  vec3 momentum = vec3(grid_momentum_sum[i]) / momentum_scale;
  vec3 force = vec3(grid_force_sum[i]) / force_scale(stress_max[0]);
#else
  float mass_here = grid_mass_sum[i];
  vec3 momentum = grid_momentum_sum[i];
  vec3 force = grid_force_sum[i];
#endif
  bool empty = !(mass_here > 0.0);
  vec3 before = empty ? vec3(0.0) : momentum / mass_here;
  grid_mass[i] = mass_here;
  grid_velocity_before[i] = before;
  grid_velocity[i] = empty ? vec3(0.0) : before + dt * (force / mass_here + gravity);
}
