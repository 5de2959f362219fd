#include "rest.glsl"

void main() {
  uint i = element_index();
  if (i < 4u && rest[i] > REST(0)) rest[i] -= REST(1);
}
