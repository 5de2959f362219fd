// The library's singular value decomposition on whole arrays.
#include "lib/svd.glsl"

void main() {
  uint i = element_index();
  if (i >= matrices_count) return;
  mat3 left, right;
  vec3 values;
  svd(matrix[i], left, values, right);
  u[i] = left;
  s[i] = values;
  v[i] = right;
}
