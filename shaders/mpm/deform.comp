// Elastic trial, then its singular values held in [1 - theta_c, 1 + theta_s]; what is cut off becomes plastic [M 21, 22].
#include "lib/finite.glsl"
#include "lib/svd.glsl"

void main() {
  uint particle = element_index();
  if (particle >= particles_count) return;
  vec2 limits = material_plastic[material[particle]];
  mat3 fe = elastic[particle] + dt * velocity_gradient[particle] * elastic[particle];
  mat3 u, v;
  vec3 s;
  svd(fe, u, s, v);
  vec3 held = clamp(s, vec3(1.0 - limits.x), vec3(1.0 + limits.y));
  // Within the limits FE stays as it is, without the rounding of U S V^T.
  if (any(notEqual(held, s))) {
    fe = mat3(u[0] * held.x, u[1] * held.y, u[2] * held.z) * transpose(v);
    plastic_det[particle] *= s.x * s.y * s.z / (held.x * held.y * held.z);
  }
  if (!is_finite(fe[0] + fe[1] + fe[2])) fault(FAULT_NOT_A_NUMBER);
  elastic[particle] = fe;
}
