// Mass and velocities of 4 x 2 nodes, four along x in two neighbouring rows, gathered from the particles of the 7 x 5 x 4 cells about them
// [M 3.4 steps 1, 3, 4]. A particle is read once for all of them, for reading costs more than arithmetic where registers are filled
// invocation by invocation; and which nodes along x a cell reaches is known when this is compiled, so that none is given a weight of zero.
// No atomics: the order of the sums is fixed.
#include "lib/blocks.glsl"
#include "lib/bspline.glsl"

struct Node {
  float mass;
  vec3 momentum, force;
};
const Node none = Node(0.0, vec3(0.0), vec3(0.0));

// A particle as all nodes of a row see it: its place along x in its cell, its mass by the splines along y and z, and its stress times what is
// left of the weight's gradient once the spline along x and its slope are set aside.
struct Seen {
  float along, mass;
  vec3 velocity, by_slope, by_spline;
};

// y, z: spline and slope along these axes. Rows of the stress: (b.w, c.z, c.w), (c.z, c.x, yz_stress), (c.w, yz_stress, c.y).
Seen seen(vec4 a, vec4 b, vec4 c, float yz_stress, vec2 y, vec2 z) {
  float w = y.x * z.x, by_y = y.y * z.x, by_z = y.x * z.y;
  return Seen(a.x, a.w * w, b.xyz, w * vec3(b.w, c.zw), by_y * vec3(c.z, c.x, yz_stress) + by_z * vec3(c.w, yz_stress, c.y));
}

void add(inout Node node, Seen particle, const int offset) {
  vec2 along = spline_and_slope(spline_piece(offset), particle.along);
  float m = particle.mass * along.x;
  node.mass += m;
  node.momentum += m * particle.velocity;
  node.force -= along.y * particle.by_slope + along.x * particle.by_spline;
}

void store(int index, Node node) {
  bool empty = !(node.mass > 0.0);
  vec3 before = empty ? vec3(0.0) : node.momentum / node.mass;
  grid_mass[index] = node.mass;
  grid_velocity_before[index] = before;
  grid_velocity[index] = empty ? vec3(0.0) : before + dt * (node.force / (grid_cell * node.mass) + gravity);
}

// Adds the particles of one cell, from number p in their order to where block_cells has the cell's end, by DO. The condition stands at the
// end: llvmpipe goes through a loop once more, with all invocations masked, to find a condition at its head false.
#define CELL(ends_at, DO)                                                                                        \
  end = int(block_cells_at(ends_at));                                                                            \
  if (p < end) do {                                                                                              \
      vec4 a = packed_particles_at(3 * p), b = packed_particles_at(3 * p + 1), c = packed_particles_at(3 * p + 2); \
      float yz_stress = packed_stress_at(p);                                                                     \
      vec2 z = spline_and_slope(piece_z, a.z);                                                                   \
      Seen here = seen(a, b, c, yz_stress, spline_and_slope(piece_y, a.y), z);                                   \
      Seen beside = seen(a, b, c, yz_stress, spline_and_slope(piece_beside, a.y), z);                            \
      DO                                                                                                         \
    } while (++p < end);
#define ADD(i, offset)         \
  add(here##i, here, offset);  \
  add(beside##i, beside, offset);

void main() {
  uint slot = spread(group_number(), active_block_count[0]);
  if (slot >= active_block_count[0]) return;
  ivec2 yz = ivec2(2u * (gl_LocalInvocationID.x & 1u), gl_LocalInvocationID.x >> 1u);
  ivec4 near_low = block_near[4u * slot], near_high = block_near[4u * slot + 1u];

  Node here0 = none, here1 = none, here2 = none, here3 = none;
  Node beside0 = none, beside1 = none, beside2 = none, beside3 = none;
  for (int row = 0; row < 20; ++row) {
    ivec2 from = ivec2(row % 5, row / 5);
    ivec2 cell = yz + from;  // from the lowest cell of this block
    ivec2 low_high = cell.y < 4 ? (cell.x < 4 ? ivec2(near_low.x, near_high.x) : ivec2(near_low.y, near_high.y))
                                : (cell.x < 4 ? ivec2(near_low.z, near_high.z) : ivec2(near_low.w, near_high.w));
    int inside = 4 * (cell.x & 3) + 16 * (cell.y & 3);
    vec4 piece_y = spline_piece(from.x - 2), piece_beside = spline_piece(from.x - 3), piece_z = spline_piece(from.y - 2);
    if (low_high.x >= 0) {
      int at = 65 * low_high.x + inside;
      int p = int(block_cells_at(at)), end;
      CELL(at + 1, ADD(0, -2))
      CELL(at + 2, ADD(0, -1) ADD(1, -2))
      CELL(at + 3, ADD(0, 0) ADD(1, -1) ADD(2, -2))
      CELL(at + 4, ADD(0, 1) ADD(1, 0) ADD(2, -1) ADD(3, -2))
    }
    if (low_high.y >= 0) {
      int at = 65 * low_high.y + inside;
      int p = int(block_cells_at(at)), end;
      CELL(at + 1, ADD(1, 1) ADD(2, 0) ADD(3, -1))
      CELL(at + 2, ADD(2, 1) ADD(3, 0))
      CELL(at + 3, ADD(3, 1))
    }
  }

  int index = int(64u * slot + 8u * gl_LocalInvocationID.x);
  store(index, here0);
  store(index + 1, here1);
  store(index + 2, here2);
  store(index + 3, here3);
  store(index + 4, beside0);
  store(index + 5, beside1);
  store(index + 6, beside2);
  store(index + 7, beside3);
}
