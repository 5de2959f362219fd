#define NOTING
#include "heightfield/support_addends.glsl"

void main() {
  int body;
  vec4 values;
  if (!addends(body, values)) return;
  for (int slot = 0; slot < 4; ++slot) note(body, slot, values[slot]);
}
