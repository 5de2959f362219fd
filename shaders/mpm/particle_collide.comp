// Rigid bodies act on the velocities of the particles inside them [M 4.4].
#include "lib/bodies.glsl"

void main() {
  uint particle = element_index();
  if (particle >= particles_count) return;
  velocity[particle] = collided(velocity[particle], position_at(int(particle)));
}
