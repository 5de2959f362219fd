#include "heightfield/support_sums.glsl"
#include "lib/body_sums.glsl"

void main() {
  int body = int(element_index());
  if (body >= int(bodies_count)) return;
  float force = total(body, 0);
  support[body] = force;
  support_point[body] = force > 0.0 ? vec3(field_min.x, 0.0, field_min.z) + vec3(total(body, 1), total(body, 2), total(body, 3)) / force : vec3(0.0);
}
