// mpm.grid_to_particles, one invocation per row of four cells along x: what the 64 nodes about a cell hold is read once for all its
// particles, and three quarters of it serve the next cell too [M 3.4 step 7].
#include "lib/blocks.glsl"
#include "lib/bspline.glsl"

// Four nodes along x: a component of their velocity each, with forces and collisions (x, y, z) and before (bx, by, bz).
struct Row {
  vec4 x, y, z, bx, by, bz;
};

// The first three nodes of the row (j, k) above the lowest cells, where the block below has them; the next one along comes with shift().
Row row_of(int low, ivec2 base, int j, int k) {
  int inside = 64 * low + 4 * ((base.x + j) & 3) + 16 * ((base.y + k) & 3);
  Row row;
  for (int i = 1; i < 4; ++i) {
    vec3 now = grid_velocity_at(inside + i), before = grid_velocity_before_at(inside + i);
    row.x[i] = now.x;
    row.y[i] = now.y;
    row.z[i] = now.z;
    row.bx[i] = before.x;
    row.by[i] = before.y;
    row.bz[i] = before.z;
  }
  return row;
}

// One cell further along x: node `next` of the block that follows.
void shift(inout Row row, int high, ivec2 base, int next, int j, int k) {
  int node = 64 * high + 4 * ((base.x + j) & 3) + 16 * ((base.y + k) & 3) + next;
  vec3 now = grid_velocity_at(node), before = grid_velocity_before_at(node);
  row = Row(vec4(row.x.yzw, now.x), vec4(row.y.yzw, now.y), vec4(row.z.yzw, now.z), vec4(row.bx.yzw, before.x),
            vec4(row.by.yzw, before.y), vec4(row.bz.yzw, before.z));
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
#define BLOCK(of, j, k) (base.y + k < 4 ? (base.x + j < 4 ? of.x : of.y) : (base.x + j < 4 ? of.z : of.w))
#define READ(row, j, k) Row row = row_of(BLOCK(lows, j, k), base, j, k);
#define SHIFT(row, j, k) shift(row, BLOCK(highs, j, k), base, next, j, k);
#define ADD(row, j, k) add(sums, row, wx, dx, wy[j], dy[j], wz[k], dz[k]);

void main() {
  uint slot = group_number();
  if (slot >= active_block_count[0]) return;
  ivec2 base = ivec2(gl_LocalInvocationID.x & 3u, gl_LocalInvocationID.x >> 2u) + 1;
  int cell = int(65u * block_entry[slot] + 4u * gl_LocalInvocationID.x);
  uint at = block_cells_at(cell), last = block_cells_at(cell + 4);
  if (at == last) return;
  ivec4 lows = block_near[4u * slot + 2u], highs = block_near[4u * slot + 3u];
  ivec3 corner = 4 * block_of(active_blocks[slot]) - 4 + ivec3(0, base);  // the lowest node on the grid, of the cell before the first
  FOR_ROWS(READ)
  for (int next = 0; next < 4; ++next) {
    ++corner.x;
    FOR_ROWS(SHIFT)
    uint end = block_cells_at(cell + next + 1);
    // The condition at the end: see gather_velocities.comp.
    if (at < end) do {
      uint particle = order_at(int(at));
      vec3 u = grid_coordinates(position[particle]) - vec3(corner);
      vec4 wx = spline_of_cell(u.x), wy = spline_of_cell(u.y), wz = spline_of_cell(u.z);
      vec4 dx = slope_of_cell(u.x), dy = slope_of_cell(u.y), dz = slope_of_cell(u.z);
      Sums sums = Sums(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
      FOR_ROWS(ADD)
      velocity_gradient[particle] = mat3(sums.by_x, sums.by_y, sums.by_z) / grid_cell;
      vec3 v = mix(sums.now, velocity[particle] + sums.now - sums.before, flip);
      if (!is_finite(v)) fault(FAULT_NOT_A_NUMBER);
      velocity[particle] = v;
    } while (++at < end);
  }
}
