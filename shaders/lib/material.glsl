// Elastoplastic snow [M 29-32]. material_elastic: mu0 and lambda0 in Pa, hardening xi, density in kg/m3.
#include "lib/svd.glsl"

vec2 hardened_lame(vec4 elastic_parameters, float plastic_determinant) {
  return elastic_parameters.xy * exp(elastic_parameters.z * (1.0 - plastic_determinant));
}

// P FE^T = 2 mu (FE - RE) FE^T + lambda (J - 1) J, in Pa: V0 times this is what grid forces are made of.
// u, s: left singular vectors and singular values of fe.
mat3 kirchhoff_stress(mat3 fe, mat3 u, vec3 s, vec2 lame) {
  // Strains d = S - 1 from F F^T - 1, whose entries are small where F is near the identity: S itself is known only to rounding of 1, and the
  // stress is what remains of it.
  mat3 e = fe - mat3(1.0);
  mat3 b = e + transpose(e) + e * transpose(e);
  vec3 d = vec3(dot(u[0], b * u[0]), dot(u[1], b * u[1]), dot(u[2], b * u[2])) / (s + 1.0);
  if (s.z < 0.5) d = s - 1.0;
  float volume_change = d.x + d.y + d.z + d.x * d.y + d.y * d.z + d.z * d.x + d.x * d.y * d.z;  // J - 1
  // In the frame of U everything is diagonal: (FE - RE) FE^T = U d S U^T.
  vec3 principal = 2.0 * lame.x * d * (d + 1.0) + lame.y * volume_change * (volume_change + 1.0);
  return mat3(u[0] * principal.x, u[1] * principal.y, u[2] * principal.z) * transpose(u);
}
mat3 kirchhoff_stress(mat3 fe, vec2 lame) {
  mat3 u, v;
  vec3 s;
  svd(fe, u, s, v);
  return kirchhoff_stress(fe, u, s, lame);
}
