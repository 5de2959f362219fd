// grad v_p = sum v_i (grad w_ip)^T, v_p = (1 - alpha) v_pic + alpha v_flip [M 3.4 step 7].
#include "lib/stencil_rows.glsl"

void main() {
  uint slot = element_index();
  if (slot >= particles_count) return;
#if HAS_ORDER
  uint particle = order[slot];  // neighbours in space are neighbours here: they read the same nodes
#else
  uint particle = slot;
#endif
  Stencil stencil = stencil_of(particle, position[particle]);
  vec3 u = stencil.u;
  vec4 wx = spline4(u.x), wy = spline4(u.y), wz = spline4(u.z);
  vec4 dx = spline_slope4(u.x), dy = spline_slope4(u.y), dz = spline_slope4(u.z);
  vec3 now = vec3(0.0), before = vec3(0.0);
  vec3 by_x = vec3(0.0), by_y = vec3(0.0), by_z = vec3(0.0);  // dv/dx, dv/dy, dv/dz
  for (int k = 0; k < stencil_width; ++k)
    for (int j = 0; j < stencil_width; ++j) {
      StencilRow row = stencil_row(stencil, j, k);
      vec3 along = vec3(0.0), slope = vec3(0.0), old = vec3(0.0);
      for (int i = 0; i < stencil_width; ++i) {
        int node = stored_node(row, i);
        vec3 v = grid_velocity_at(node);
        along = fma(vec3(wx[i]), v, along);
        slope = fma(vec3(dx[i]), v, slope);
        old = fma(vec3(wx[i]), grid_velocity_before_at(node), old);
      }
      float w = wy[j] * wz[k];
      now = fma(vec3(w), along, now);
      before = fma(vec3(w), old, before);
      by_x = fma(vec3(w), slope, by_x);
      by_y = fma(vec3(dy[j] * wz[k]), along, by_y);
      by_z = fma(vec3(wy[j] * dz[k]), along, by_z);
    }
  velocity_gradient[particle] = mat3(by_x, by_y, by_z) / grid_cell;
  vec3 v = mix(now, velocity[particle] + now - before, flip);
  if (!is_finite(v)) fault(FAULT_NOT_A_NUMBER);
  velocity[particle] = v;
}
