// Sets the nodes of the blocks that were active in the last step to zero: they may not be active in this one.
#define NODES_ACTIVE 1
#include "lib/active_node.glsl"

void main() {
  ivec3 node;
  if (!active_node(node)) return;
  int i = node_index(node);
  grid_mass[i] = 0.0;
  grid_velocity[i] = vec3(0.0);
  grid_velocity_before[i] = vec3(0.0);
}
