#include "lib/divide.glsl"

void main() {
  uint i = element_index();
  if (i < pairs_count) result[i] = divided(pair[i].x, pair[i].y);
}
