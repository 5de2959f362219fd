// Singular values of 3 x 3 matrices after McAdams et al. 2011: Jacobi rotations on F^T F, then QR of F V by Givens rotations. Both
// rotations are gathered in quaternions, which keeps them orthogonal to rounding; nothing is divided by a singular value, so zero and
// rank-1 matrices give no NaN.

#include "lib/quaternion.glsl"

mat3 rotation_matrix(vec4 q) {
  vec3 d = 2.0 * q.xyz * q.xyz;
  float xy = 2.0 * q.x * q.y, xz = 2.0 * q.x * q.z, yz = 2.0 * q.y * q.z;
  vec3 w = 2.0 * q.w * q.xyz;
  return mat3(1.0 - d.y - d.z, xy + w.z, xz - w.y, xy - w.z, 1.0 - d.x - d.z, yz + w.x, xz + w.y, yz - w.x, 1.0 - d.x - d.y);
}

vec4 turn(int axis, float sine, float cosine) {
  return vec4(axis == 0 ? sine : 0.0, axis == 1 ? sine : 0.0, axis == 2 ? sine : 0.0, cosine);
}

vec4 renormalized(vec4 q) { return q * (1.5 - 0.5 * dot(q, q)); }

// One Jacobi rotation, about `axis`, of a symmetric matrix: makes its element pq zero, by at most 45 degrees. k is the third axis.
void jacobi(int axis, inout float pp, inout float qq, inout float pq, inout float pk, inout float qk, inout vec4 rotation) {
  bool idle = pq == 0.0;
  float tau = 0.5 * (qq - pp) / (idle ? 1.0 : pq);
  float t = idle ? 0.0 : (tau < 0.0 ? -1.0 : 1.0) / (abs(tau) + sqrt(1.0 + tau * tau));
  float c = inversesqrt(1.0 + t * t);
  float s = t * c;
  pp -= t * pq;
  qq += t * pq;
  pq = 0.0;
  float old = pk;
  pk = c * old - s * qk;
  qk = s * old + c * qk;
  float half_cosine = sqrt(0.5 + 0.5 * c);
  rotation = product(rotation, turn(axis, -0.5 * s / half_cosine, half_cosine));
}

// The rotation that turns (a, b) onto (+, 0).
vec4 givens_turn(int axis, float a, float b) {
  float rho = sqrt(a * a + b * b);
  float cosine = abs(a) + max(rho, 1.0e-18);
  float sine = abs(b) > 1.0e-12 ? b : 0.0;  // below rounding of F, whose size is 1; and denormal numbers would follow, which are slow
  float scale = inversesqrt(cosine * cosine + sine * sine);
  return a < 0.0 && rho > 1.0e-18 ? turn(axis, cosine * scale, sine * scale) : turn(axis, sine * scale, cosine * scale);
}

void order_columns(inout mat3 b, inout mat3 v, int i, int j) {
  if (dot(b[i], b[i]) >= dot(b[j], b[j])) return;
  vec3 column = b[i];
  b[i] = b[j];
  b[j] = -column;
  column = v[i];
  v[i] = v[j];
  v[j] = -column;
}

// F = U diag(S) V^T; U and V are proper rotations, S[0] >= S[1] >= |S[2]|, and a negative sign is that of S[2].
void svd(mat3 f, out mat3 u, out vec3 s, out mat3 v) {
  float size = 0.0;
  for (int c = 0; c < 3; ++c) size = max(size, max(abs(f[c].x), max(abs(f[c].y), abs(f[c].z))));
  float inverse_size = size > 0.0 ? 1.0 / size : 0.0;  // F^T F must neither overflow nor vanish
  f *= inverse_size;

  // Every sweep starts from F V anew: rotating F^T F alone loses the small singular values of rank-2 matrices.
  vec4 right = vec4(0.0, 0.0, 0.0, 1.0);
  const float small = 1.0e-14;
  for (int sweep = 0; sweep < 4; ++sweep) {
    mat3 fv = f * rotation_matrix(right);
    float xx = dot(fv[0], fv[0]), yy = dot(fv[1], fv[1]), zz = dot(fv[2], fv[2]);
    float xy = dot(fv[0], fv[1]), yz = dot(fv[1], fv[2]), zx = dot(fv[2], fv[0]);
    if (xy * xy <= small * xx * yy && yz * yz <= small * yy * zz && zx * zx <= small * zz * xx) break;
    jacobi(2, xx, yy, xy, zx, yz, right);
    jacobi(1, zz, xx, zx, yz, xy, right);
    jacobi(0, yy, zz, yz, xy, zx, right);
    right = renormalized(right);
  }
  v = rotation_matrix(right);
  mat3 b = f * v;
  order_columns(b, v, 0, 1);
  order_columns(b, v, 0, 2);
  order_columns(b, v, 1, 2);

  // b[column][row]: rows (0, 1), (0, 2), then (1, 2).
  vec4 left = givens_turn(2, b[0][0], b[0][1]);
  mat3 r = transpose(rotation_matrix(left)) * b;
  vec4 q = givens_turn(1, r[0][0], -r[0][2]);
  left = normalize(product(left, q));
  r = transpose(rotation_matrix(left)) * b;
  q = givens_turn(0, r[1][1], r[1][2]);
  left = normalize(product(left, q));
  u = rotation_matrix(renormalized(left));
  s = vec3(dot(u[0], b[0]), dot(u[1], b[1]), dot(u[2], b[2])) * size;
}
