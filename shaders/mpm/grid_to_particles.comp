// grad v_p = sum v_i (grad w_ip)^T, v_p = (1 - alpha) v_pic + alpha v_flip [M 3.4 step 7].
#include "lib/grid.glsl"
#include "lib/bspline.glsl"

void main() {
  uint slot = element_index();
  if (slot >= particles_count) return;
#if HAS_ORDER
  uint particle = order[slot];  // neighbours in space are neighbours here: they read the same nodes
#else
  uint particle = slot;
#endif
  vec3 x = grid_coordinates(position[particle]);
  ivec3 base = clamp(stencil_base(x), ivec3(0), grid_nodes - stencil_width);
  vec3 u = x - vec3(base);
  vec4 wx = spline4(u.x), wy = spline4(u.y), wz = spline4(u.z);
  vec4 dx = spline_slope4(u.x), dy = spline_slope4(u.y), dz = spline_slope4(u.z);
  vec3 now = vec3(0.0), before = vec3(0.0);
  vec3 by_x = vec3(0.0), by_y = vec3(0.0), by_z = vec3(0.0);  // dv/dx, dv/dy, dv/dz
  for (int k = 0; k < stencil_width; ++k)
    for (int j = 0; j < stencil_width; ++j) {
      int row = node_index(base + ivec3(0, j, k));
      vec3 v0 = grid_velocity_at(row), v1 = grid_velocity_at(row + 1), v2 = grid_velocity_at(row + 2);
      vec3 along = wx.x * v0 + wx.y * v1 + wx.z * v2;
      vec3 slope = dx.x * v0 + dx.y * v1 + dx.z * v2;
      vec3 old = wx.x * grid_velocity_before_at(row) + wx.y * grid_velocity_before_at(row + 1) + wx.z * grid_velocity_before_at(row + 2);
#if KERNEL_CUBIC
      vec3 v3 = grid_velocity_at(row + 3);
      along += wx.w * v3;
      slope += dx.w * v3;
      old += wx.w * grid_velocity_before_at(row + 3);
#endif
      now += wy[j] * wz[k] * along;
      before += wy[j] * wz[k] * old;
      by_x += wy[j] * wz[k] * slope;
      by_y += dy[j] * wz[k] * along;
      by_z += wy[j] * dz[k] * along;
    }
  velocity_gradient[particle] = mat3(by_x, by_y, by_z) / grid_cell;
  vec3 v = mix(now, velocity[particle] + now - before, flip);
  if (!is_finite(v)) fault(FAULT_NOT_A_NUMBER);
  velocity[particle] = v;
}
