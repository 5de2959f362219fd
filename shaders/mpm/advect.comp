// x_p += dt v_p [M 3.4 step 10].
#include "lib/grid.glsl"

void main() {
  uint particle = element_index();
  if (particle >= particles_count) return;
  vec3 x = position[particle] + dt * velocity[particle];
  if (!is_finite(x))
    fault(FAULT_NOT_A_NUMBER);
  else if (!inside_domain(x))
    fault(FAULT_LEFT_DOMAIN);
  position[particle] = x;
}
