// Rigid bodies act on the velocities of the grid nodes inside them [M 4.4].
#include "lib/active_node.glsl"
#include "lib/bodies.glsl"

void main() {
  ivec3 node;
  int i;
  if (!active_node(node, i)) return;
  if (grid_mass[i] > 0.0) grid_velocity[i] = collided(grid_velocity[i], node_position(node));
}
