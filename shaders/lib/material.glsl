// Elastoplastic snow [M 29-32]. material_elastic: mu0 and lambda0 in Pa, hardening xi, density in kg/m3.
#include "lib/svd.glsl"

vec2 hardened_lame(vec4 elastic_parameters, float plastic_determinant) {
  return elastic_parameters.xy * exp(elastic_parameters.z * (1.0 - plastic_determinant));
}

// P FE^T = 2 mu (FE - RE) FE^T + lambda (J - 1) J, in Pa: V0 times this is what grid forces are made of.
mat3 kirchhoff_stress(mat3 fe, vec2 lame) {
  mat3 u, v;
  vec3 s;
  svd(fe, u, s, v);
  float j = s.x * s.y * s.z;
  // In the frame of U everything is diagonal: (FE - RE) FE^T = U (S - 1) S U^T, without the cancellation of FE - RE.
  vec3 principal = 2.0 * lame.x * (s - 1.0) * s + lame.y * (j - 1.0) * j;
  return mat3(u[0] * principal.x, u[1] * principal.y, u[2] * principal.z) * transpose(u);
}
