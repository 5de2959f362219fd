// F = m (-v) / time_constant at the mean point of what is displaced [H 3.6-3.8].
#include "heightfield/resistance_sums.glsl"
#include "lib/body_sums.glsl"

void main() {
  int body = int(element_index());
  if (body >= int(bodies_count)) return;
  float mass = total(body, 0);
#if HAS_DISPLACED_MASS
  displaced_mass[body] = mass;
#endif
  contact_point[body] = mass > 0.0 ? vec3(field_min.x, 0.0, field_min.z) + vec3(total(body, 1), total(body, 2), total(body, 3)) / mass : vec3(0.0);
  resistance[body] = -mass * body_velocity[body] / time_constant;
}
