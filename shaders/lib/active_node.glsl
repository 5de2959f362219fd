// The node of this invocation. NODES_ALL: one invocation per node of the grid. NODES_ACTIVE: one group of 64 per block of 4 x 4 x 4 nodes in
// active_blocks. False where there is none.
#include "lib/blocks.glsl"

#if NODES_ACTIVE
bool active_node(out ivec3 node) {
  if (group_number() >= active_block_count[0]) return false;
  node = block_node(active_blocks[group_number()], gl_LocalInvocationID.x);
  return all(lessThan(node, grid_nodes));
}
#else
bool active_node(out ivec3 node) {
  node = node_of(min(element_index(), nodes_count - 1u));
  return element_index() < nodes_count;
}
#endif
