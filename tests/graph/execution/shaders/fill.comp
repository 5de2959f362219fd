#include "rest.glsl"

void main() {
  uint i = element_index();
  const int values[4] = int[4](3, 1, 4, 2);
  if (i < 4u) rest[i] = REST(values[i]);
}
