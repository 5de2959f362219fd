// f_i = - sum_p V_p0 P(FE_p) FE_p^T grad w_ip [M 26, 32]; one invocation per particle and node.
#include "lib/grid.glsl"
#include "lib/bspline.glsl"
#include "lib/accumulate.glsl"
#if ACCUMULATE_FIXED
#include "lib/force_scale.glsl"
#endif

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
  vec3 w = vec3(spline(u.x), spline(u.y), spline(u.z));
  vec3 gradient = vec3(spline_slope(u.x) * w.y * w.z, w.x * spline_slope(u.y) * w.z, w.x * w.y * spline_slope(u.z)) / grid_cell;
  vec3 force = -(stress[particle] * gradient);
  int i = node_index(node);
#if ACCUMULATE_FIXED
  float scale = force_scale(stress_max[0]);
#endif
  ACCUMULATE(grid_force_sum, 4 * i, force.x, scale)
  ACCUMULATE(grid_force_sum, 4 * i + 1, force.y, scale)
  ACCUMULATE(grid_force_sum, 4 * i + 2, force.z, scale)
}
