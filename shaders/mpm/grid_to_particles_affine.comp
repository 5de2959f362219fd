// v_p = sum w v_i, C_p = (4/h^2) sum w v_i (x_i - x_p)^T (Jiang et al. 2015; 4/h^2 is the quadratic kernel's).
#define KERNEL_CUBIC 0
#define NODES_ACTIVE 1
#include "lib/stencil_rows.glsl"

void main() {
  uint slot = element_index();
  if (slot >= particles_count) return;
  uint particle = order[slot];  // neighbours in space are neighbours here: they read the same nodes
  Stencil stencil = stencil_of(particle, position_at(int(particle)));
  vec3 u = stencil.u;
  vec4 wx = spline4(u.x), wy = spline4(u.y), wz = spline4(u.z);
  vec3 v = vec3(0.0), by_x = vec3(0.0), by_y = vec3(0.0), by_z = vec3(0.0);
  for (int k = 0; k < stencil_width; ++k)
    for (int j = 0; j < stencil_width; ++j) {
      StencilRow row = stencil_row(stencil, j, k);
      vec3 along = vec3(0.0), slope = vec3(0.0);
      for (int i = 0; i < stencil_width; ++i) {
        vec3 share = wx[i] * grid_velocity_at(stored_node(row, i));
        along += share;
        slope += (float(i) - u.x) * share;  // (x_i - x_p) / h
      }
      float w = wy[j] * wz[k];
      v += w * along;
      by_x += w * slope;
      by_y += w * (float(j) - u.y) * along;
      by_z += w * (float(k) - u.z) * along;
    }
  if (!is_finite(v)) fault(FAULT_NOT_A_NUMBER);
  velocity_gradient[particle] = (4.0 / grid_cell) * mat3(by_x, by_y, by_z);
  velocity[particle] = v;
}
