// mpm.grid_to_particles, one group per block: the 7 x 7 x 7 nodes that its particles reach are read once, into shared memory [M 3.4 step 7].
// One component after another, so that invocations beside each other, whose particles lie in cells beside each other, read numbers beside
// each other.
#include "lib/blocks.glsl"
#include "lib/block_sums.glsl"
#include "lib/bspline.glsl"

shared float now_x[SUM_NODES], now_y[SUM_NODES], now_z[SUM_NODES];
shared float before_x[SUM_NODES], before_y[SUM_NODES], before_z[SUM_NODES];

void read_node(int i, ivec4 lows, ivec4 highs) {
  ivec3 at = ivec3(i % SUM_EDGE, i / SUM_EDGE % SUM_EDGE, i / (SUM_EDGE * SUM_EDGE)) + 1;  // from the lowest node of the block below
  int corner = at.y / 4 + 2 * (at.z / 4);
  int block = at.x < 4 ? lows[corner] : highs[corner];
  int stored = 64 * block + (at.x & 3) + 4 * (at.y & 3) + 16 * (at.z & 3);
  vec3 now = grid_velocity_at(stored), before = grid_velocity_before_at(stored);
  now_x[i] = now.x;
  now_y[i] = now.y;
  now_z[i] = now.z;
  before_x[i] = before.x;
  before_y[i] = before.y;
  before_z[i] = before.z;
}

void main() {
  uint slot = group_number();
  if (slot >= active_block_count[0]) return;
  int cells = int(65u * block_entry[slot]);
  uint first = block_cells_at(cells), end = block_cells_at(cells + 64);
  if (first == end) return;
  ivec4 lows = block_near[4u * slot + 2u], highs = block_near[4u * slot + 3u];
  for (int i = int(gl_LocalInvocationID.x); i < SUM_NODES; i += int(gl_WorkGroupSize.x)) read_node(i, lows, highs);
  barrier();

  ivec3 lowest = 4 * block_of(active_blocks[slot]) - 3;
  for (uint at = first + gl_LocalInvocationID.x; at < end; at += gl_WorkGroupSize.x) {
    uint particle = order_at(int(at));
    vec3 x = grid_coordinates(position[particle]);
    ivec3 base = clamp(stencil_base(x) - lowest, ivec3(0), ivec3(SUM_EDGE - stencil_width));
    vec3 u = x - vec3(lowest + base);
    vec4 wx = spline4(u.x), wy = spline4(u.y), wz = spline4(u.z);
    vec4 dx = spline_slope4(u.x), dy = spline_slope4(u.y), dz = spline_slope4(u.z);
    vec3 now = vec3(0.0), before = vec3(0.0), by_x = vec3(0.0), by_y = vec3(0.0), by_z = vec3(0.0);
    for (int k = 0; k < stencil_width; ++k)
      for (int j = 0; j < stencil_width; ++j) {
        int row = sum_index(base + ivec3(0, j, k));
        vec3 along = vec3(0.0), slope = vec3(0.0), old = vec3(0.0);
        for (int i = 0; i < stencil_width; ++i) {
          vec3 v = vec3(now_x[row + i], now_y[row + i], now_z[row + i]);
          along += wx[i] * v;
          slope += dx[i] * v;
          old += wx[i] * vec3(before_x[row + i], before_y[row + i], before_z[row + i]);
        }
        float w = wy[j] * wz[k];
        now += w * along;
        before += w * old;
        by_x += w * slope;
        by_y += (dy[j] * wz[k]) * along;
        by_z += (wy[j] * dz[k]) * along;
      }
    velocity_gradient[particle] = mat3(by_x, by_y, by_z) / grid_cell;
    vec3 v = mix(now, velocity[particle] + now - before, flip);
    if (!is_finite(v)) fault(FAULT_NOT_A_NUMBER);
    velocity[particle] = v;
  }
}
