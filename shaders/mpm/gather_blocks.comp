// Mass and velocities of nodes from what the particles of their own block and of the seven above give to them (gather_block_sums.comp)
// [M 3.4 steps 1, 3, 4]. Always in the same order, so that sums repeat to the bit.
#include "lib/blocks.glsl"
#include "lib/block_sums.glsl"

void main() {
  uint slot = group_number();
  if (slot >= active_block_count[0]) return;
  ivec3 node = ivec3(local_node(gl_LocalInvocationID.x));
  ivec4 near_low = block_near[4u * slot], near_high = block_near[4u * slot + 1u];
  float mass_here = 0.0;
  vec3 momentum = vec3(0.0), force = vec3(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 above = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    int entry = above.x == 0 ? near_low[corner >> 1] : near_high[corner >> 1];
    ivec3 at = node + 3 - 4 * above;  // from the lowest node that the particles there reach
    if (entry < 0 || any(lessThan(at, ivec3(0)))) continue;
    if (block_cells_at(65 * entry) == block_cells_at(65 * entry + 64)) continue;
    int sums = SUM_KINDS * SUM_NODES * int(block_slot[entry]) + sum_index(at);
    mass_here += block_sums[sums];
    momentum += vec3(block_sums[sums + SUM_NODES], block_sums[sums + 2 * SUM_NODES], block_sums[sums + 3 * SUM_NODES]);
    force += vec3(block_sums[sums + 4 * SUM_NODES], block_sums[sums + 5 * SUM_NODES], block_sums[sums + 6 * SUM_NODES]);
  }
  int index = int(64u * slot + gl_LocalInvocationID.x);
  bool empty = !(mass_here > 0.0);
  vec3 before = empty ? vec3(0.0) : momentum / mass_here;
  grid_mass[index] = mass_here;
  grid_velocity_before[index] = before;
  grid_velocity[index] = empty ? vec3(0.0) : before + dt * (force / grid_cell / mass_here + gravity);
}
