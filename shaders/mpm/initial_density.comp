// rho_p0 = sum_i m_i w_ip / h^3, V_p0 = m_p / rho_p0 [M 3.4 step 2].
#include "lib/stencil_rows.glsl"

void main() {
  uint particle = element_index();
  if (particle >= particles_count) return;
  if (!inside_domain(position[particle])) return;
  Stencil stencil = stencil_of(particle, position[particle]);
  vec3 u = stencil.u;
  vec4 wx = spline4(u.x), wy = spline4(u.y), wz = spline4(u.z);
  float sum = 0.0;
  for (int k = 0; k < stencil_width; ++k)
    for (int j = 0; j < stencil_width; ++j) {
      StencilRow row = stencil_row(stencil, j, k);
      for (int i = 0; i < stencil_width; ++i) sum += wx[i] * wy[j] * wz[k] * grid_mass[stored_node(row, i)];
    }
  float density_here = sum / (grid_cell * grid_cell * grid_cell);
#if HAS_DENSITY
  density[particle] = density_here;
#endif
  if (density_here > 0.0) volume[particle] = mass[particle] / density_here;
}
