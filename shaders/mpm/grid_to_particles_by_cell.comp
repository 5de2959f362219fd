// mpm.grid_to_particles, one invocation per cell: what the 64 nodes about a cell hold is read once for all its particles
// [M 3.4 step 7].
#include "lib/blocks.glsl"
#include "lib/bspline.glsl"

// Four nodes along x: a component of their velocity each, with forces and collisions (x, y, z) and before (bx, by, bz).
struct Row {
  vec4 x, y, z, bx, by, bz;
};

// low, high: slots of the block that has base and of the next one along x; base: lowest node, from the lowest one of the block below.
Row row_of(int low, int high, ivec3 base, int j, int k) {
  int inside = 4 * ((base.y + j) & 3) + 16 * ((base.z + k) & 3) + base.x;
  Row row;
  for (int i = 0; i < 4; ++i) {
    int node = i + inside + (base.x + i < 4 ? 64 * low : 64 * high - 4);
    vec3 now = grid_velocity_at(node), before = grid_velocity_before_at(node);
    row.x[i] = now.x;
    row.y[i] = now.y;
    row.z[i] = now.z;
    row.bx[i] = before.x;
    row.by[i] = before.y;
    row.bz[i] = before.z;
  }
  return row;
}

struct Sums {
  vec3 now, before, by_x, by_y, by_z;  // velocity, velocity before, dv/dx, dv/dy, dv/dz
};

void add(inout Sums sums, Row row, vec4 w, vec4 slope, float wy, float dy, float wz, float dz) {
  vec3 along = vec3(dot(w, row.x), dot(w, row.y), dot(w, row.z));
  float wyz = wy * wz;
  sums.now += wyz * along;
  sums.before += wyz * vec3(dot(w, row.bx), dot(w, row.by), dot(w, row.bz));
  sums.by_x += wyz * vec3(dot(slope, row.x), dot(slope, row.y), dot(slope, row.z));
  sums.by_y += (dy * wz) * along;
  sums.by_z += (wy * dz) * along;
}

// Written out, since every row must be a value of its own: an array that is indexed in a loop is kept in memory.
#define FOR_ROWS(DO)                                                                                              \
  DO(r00, 0, 0) DO(r10, 1, 0) DO(r20, 2, 0) DO(r30, 3, 0) DO(r01, 0, 1) DO(r11, 1, 1) DO(r21, 2, 1) DO(r31, 3, 1) \
  DO(r02, 0, 2) DO(r12, 1, 2) DO(r22, 2, 2) DO(r32, 3, 2) DO(r03, 0, 3) DO(r13, 1, 3) DO(r23, 2, 3) DO(r33, 3, 3)
#define BLOCK(of, j, k) (base.z + k < 4 ? (base.y + j < 4 ? of.x : of.y) : (base.y + j < 4 ? of.z : of.w))
#define READ(row, j, k) Row row = row_of(BLOCK(lows, j, k), BLOCK(highs, j, k), base, j, k);
#define ADD(row, j, k) add(sums, row, wx, dx, wy[j], dy[j], wz[k], dz[k]);

void main() {
  uint slot = group_number();
  if (slot >= active_block_count[0]) return;
  int cell = int(65u * block_entry[slot] + gl_LocalInvocationID.x);
  uint first = block_cells_at(cell), end = block_cells_at(cell + 1);
  if (first == end) return;
  ivec4 lows = block_near[4u * slot + 2u], highs = block_near[4u * slot + 3u];
  ivec3 base = ivec3(local_node(gl_LocalInvocationID.x)) + 1;
  ivec3 corner = 4 * block_of(active_blocks[slot]) - 4 + base;  // the lowest node on the grid
  FOR_ROWS(READ)
  for (uint at = first; at < end; ++at) {
    uint particle = order_at(int(at));
    vec3 u = grid_coordinates(position[particle]) - vec3(corner);
    const vec4 nodes = vec4(0.0, 1.0, 2.0, 3.0);
    vec4 wx = spline(u.x - nodes), wy = spline(u.y - nodes), wz = spline(u.z - nodes);
    vec4 dx = spline_slope(u.x - nodes), dy = spline_slope(u.y - nodes), dz = spline_slope(u.z - nodes);
    Sums sums = Sums(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    FOR_ROWS(ADD)
    velocity_gradient[particle] = mat3(sums.by_x, sums.by_y, sums.by_z) / grid_cell;
    vec3 v = mix(sums.now, velocity[particle] + sums.now - sums.before, flip);
    if (!is_finite(v)) fault(FAULT_NOT_A_NUMBER);
    velocity[particle] = v;
  }
}
