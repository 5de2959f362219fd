// Costs of a step in the eight directions for each body: 1/s along the axes, diagonals the Euclidean combination of their two sides. No cell
// is known yet to lie under it.
#include "lib/direction.glsl"

const float infinity = uintBitsToFloat(0x7f800000u);

float cost(vec3 velocity, vec2 to) {
  float s = direction_factor(velocity, to);
  return s > 0.0 ? 1.0 / s : infinity;
}

void main() {
  uint body = element_index();
  if (body >= bodies_count) return;
  vec3 v = body_velocity[body];
  float left = cost(v, vec2(-1, 0)), right = cost(v, vec2(1, 0)), down = cost(v, vec2(0, -1)), up = cost(v, vec2(0, 1));
  step_costs[2u * body] = vec4(left, right, down, up);
  step_costs[2u * body + 1u] =
      vec4(length(vec2(left, down)), length(vec2(right, down)), length(vec2(left, up)), length(vec2(right, up)));
  for (uint side = 0u; side < 4u; ++side) covered_reach[4u * body + side] = side < 2u ? 0xffffffffu : 0u;
}
