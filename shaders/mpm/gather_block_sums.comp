// What the particles of one block give to the nodes about it [M 3.4 steps 1, 3], one group per block. Particles are read once, 64 at a time, into
// shared memory. Then, cell by cell, every invocation has one of the 64 nodes that the cell's particles reach, and adds up over them in
// registers: all read the same particle at once and work on different nodes. What a cell has given is added to the block's sums in shared
// memory, where no two invocations meet. No atomics, and the order of the sums is fixed; gather_blocks.comp puts blocks together.
//
// A node passes from one invocation to another between two cells. FORM_SHARED: the group waits there. FORM_SUBGROUP: only the subgroup does,
// since cells of one layer give to a plane of nodes by the same 16 invocations, which a subgroup of 16 or more holds; the group waits between layers.
#include "lib/blocks.glsl"
#include "lib/block_sums.glsl"
#include "lib/bspline.glsl"
#if FORM_SUBGROUP
#include "lib/subgroups.glsl"
#else
uint invocation_by_subgroup() { return gl_LocalInvocationID.x; }
#define WAIT_FOR_SUBGROUP barrier();
#endif

const uint CHUNK = 64u;  // as many as invocations
shared vec4 place_and_mass[CHUNK];  // place in the block, in cells from its lowest one
shared vec4 velocity_and_xx[CHUNK];
shared vec4 stress_yy_zz_xy_xz[CHUNK];
shared float stress_yz[CHUNK];
shared uint cell_first[65];
shared float sums[SUM_KINDS * SUM_NODES];

// The particle in sorted order becomes the chunk's `here`th.
void stage_particle(int at, uint here, vec3 lowest) {
  int particle = int(order_at(at));
  mat3 s = stress_at(particle);
  place_and_mass[here] = vec4(grid_coordinates(position_at(particle)) - lowest, mass_at(particle));
  velocity_and_xx[here] = vec4(velocity_at(particle), s[0][0]);
  stress_yy_zz_xy_xz[here] = vec4(s[1][1], s[2][2], s[0][1], s[0][2]);
  stress_yz[here] = s[1][2];
}

void main() {
  uint slot = group_number();
  if (slot >= active_block_count[0]) return;
  int cells = int(65u * block_entry[slot]);
  uint first = block_cells_at(cells), end = block_cells_at(cells + 64);
  if (first == end) return;  // nobody asks for its sums
  uint invocation = invocation_by_subgroup();
  for (uint i = invocation; i < 65u; i += CHUNK) cell_first[i] = block_cells_at(cells + int(i));
  for (uint i = invocation; i < uint(SUM_KINDS * SUM_NODES); i += CHUNK) sums[i] = 0.0;
  vec3 lowest = vec3(4 * block_of(active_blocks[slot]) - 2);
  ivec3 node = ivec3(local_node(invocation));  // from the cell's lowest one
  vec4 piece_x = spline_piece(1 - node.x), piece_y = spline_piece(1 - node.y), piece_z = spline_piece(1 - node.z);

  for (uint layer = 0u; layer < 4u; ++layer) {
    barrier();
    for (uint cell = 16u * layer; cell < 16u * layer + 16u; ++cell) {
      uint cell_end = cell_first[cell + 1u];
      if (cell_first[cell] == cell_end) continue;
      vec3 corner = vec3(local_node(cell));
      float mass_here = 0.0;
      vec3 momentum = vec3(0.0), force = vec3(0.0);
      for (uint at = cell_first[cell]; at < cell_end; ++at) {
        uint here = (at - first) % CHUNK;
        if (here == 0u) {
          barrier();
          if (at + invocation < end) stage_particle(int(at + invocation), invocation, lowest);
          barrier();
        }
        vec4 a = place_and_mass[here], b = velocity_and_xx[here], c = stress_yy_zz_xy_xz[here];
        float yz = stress_yz[here];
        vec3 inside = a.xyz - corner;
        vec2 x = spline_and_slope(piece_x, inside.x), y = spline_and_slope(piece_y, inside.y), z = spline_and_slope(piece_z, inside.z);
        float wyz = y.x * z.x;
        vec3 gradient = vec3(x.y * wyz, x.x * (y.y * z.x), x.x * (y.x * z.y));
        float m = a.w * (x.x * wyz);
        mass_here += m;
        momentum += m * b.xyz;
        force -= vec3(b.w * gradient.x + c.z * gradient.y + c.w * gradient.z, c.z * gradient.x + c.x * gradient.y + yz * gradient.z,
                      c.w * gradient.x + yz * gradient.y + c.y * gradient.z);
      }
      WAIT_FOR_SUBGROUP
      int at_node = sum_index(ivec3(local_node(cell)) + node);
      sums[at_node] += mass_here;
      for (int i = 0; i < 3; ++i) {
        sums[(1 + i) * SUM_NODES + at_node] += momentum[i];
        sums[(4 + i) * SUM_NODES + at_node] += force[i];
      }
    }
  }
  barrier();
  uint stored = uint(SUM_KINDS * SUM_NODES) * slot;
  for (uint i = invocation; i < uint(SUM_KINDS * SUM_NODES); i += CHUNK) block_sums[stored + i] = sums[i];
}
