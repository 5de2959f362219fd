// The node of this invocation, and where it is stored. NODES_ALL: one invocation per node of the grid. NODES_ACTIVE: one group of 64 per
// block that particles reach. False where there is none.
#include "lib/blocks.glsl"

#if NODES_ACTIVE
bool active_node(out ivec3 node, out int index) {
  if (group_number() >= active_block_count[0]) return false;
  node = 4 * block_of(active_blocks[group_number()]) + ivec3(local_node(gl_LocalInvocationID.x));
  index = int(64u * group_number() + gl_LocalInvocationID.x);
  return all(lessThan(node, grid_nodes));
}
#else
bool active_node(out ivec3 node, out int index) {
  index = int(min(element_index(), nodes_count - 1u));
  node = node_of(uint(index));
  return element_index() < nodes_count;
}
#endif
