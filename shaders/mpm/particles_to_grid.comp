// m_i = sum m_p w_ip, (m v)_i = sum m_p v_p w_ip [M 3.4 step 1]; one invocation per particle and node.
#include "lib/grid.glsl"
#include "lib/bspline.glsl"
#include "lib/accumulate.glsl"

void main() {
  const uint stencil = uint(stencil_width * stencil_width * stencil_width);
  uint particle = element_index() / stencil;
  uint k = element_index() % stencil;
  if (particle >= particles_count) return;
  uint width = uint(stencil_width);
  vec3 x = grid_coordinates(position[particle]);
  ivec3 node = stencil_base(x) + ivec3(k % width, k / width % width, k / (width * width));
  if (any(lessThan(node, ivec3(0))) || any(greaterThanEqual(node, grid_nodes))) return;
  vec3 u = x - vec3(node);
  float weighted_mass = mass[particle] * spline(u.x) * spline(u.y) * spline(u.z);
  vec3 momentum = weighted_mass * velocity[particle];
  int i = node_index(node);
  ACCUMULATE(grid_mass_sum, i, weighted_mass, mass_scale)
  ACCUMULATE(grid_momentum_sum, 4 * i, momentum.x, momentum_scale)
  ACCUMULATE(grid_momentum_sum, 4 * i + 1, momentum.y, momentum_scale)
  ACCUMULATE(grid_momentum_sum, 4 * i + 2, momentum.z, momentum_scale)
}
