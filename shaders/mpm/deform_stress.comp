// mpm.deform and mpm.stress in one: both need the singular values of the same matrix [M 21, 22, 26, 29-32].
#include "lib/finite.glsl"
#include "lib/material.glsl"

void main() {
  uint index = element_index();
  if (index >= particles_count) return;
  int particle = int(index);
  int m = material_at(particle);
  vec2 limits = material_plastic_at(m);
  mat3 fe = elastic[particle];
  fe += dt * velocity_gradient_at(particle) * fe;
  mat3 u, v;
  vec3 s;
  svd(fe, u, s, v);
  vec3 held = clamp(s, vec3(1.0 - limits.x), vec3(1.0 + limits.y));
  float determinant = plastic_det[particle];
  // Within the limits FE stays as it is, without the rounding of U S V^T.
  if (any(notEqual(held, s))) {
    fe = mat3(u[0] * held.x, u[1] * held.y, u[2] * held.z) * transpose(v);
    determinant *= s.x * s.y * s.z / (held.x * held.y * held.z);
    plastic_det[particle] = determinant;
  }
  elastic[particle] = fe;
  mat3 value = volume_at(particle) * kirchhoff_stress(fe, u, held, hardened_lame(material_elastic_at(m), determinant));
  if (!is_finite(fe[0] + fe[1] + fe[2] + value[0] + value[1] + value[2])) fault(FAULT_NOT_A_NUMBER);
  stress[particle] = value;
}
