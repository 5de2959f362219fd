// Mass and velocities of four nodes in a row along x, gathered from the particles of the 7 x 4 x 4 cells about them
// [M 3.4 steps 1, 3, 4]. What a particle has in common for all four is worked out once; rows of cells hold their particles one after
// another within a block, so there are two runs to read a row. No atomics: the order of the sums is fixed.
#include "lib/blocks.glsl"
#include "lib/bspline.glsl"

void main() {
  uint slot = group_number();
  if (slot >= active_block_count[0]) return;
  ivec2 yz = ivec2(gl_LocalInvocationID.x & 3u, gl_LocalInvocationID.x >> 2u);
  ivec3 node = 4 * block_of(active_blocks[slot]) + ivec3(0, yz);
  ivec4 near_low = block_near[4u * slot], near_high = block_near[4u * slot + 1u];
  float per_cell = 1.0 / grid_cell;

  // One component per node.
  vec4 mass_here = vec4(0.0), momentum_x = vec4(0.0), momentum_y = vec4(0.0), momentum_z = vec4(0.0);
  vec4 force_x = vec4(0.0), force_y = vec4(0.0), force_z = vec4(0.0);
  for (int row = 0; row < 16; ++row) {
    ivec2 cell = yz + ivec2(row & 3, row >> 2);  // from the lowest cell of this block
    ivec2 low_high = cell.y < 4 ? (cell.x < 4 ? ivec2(near_low.x, near_high.x) : ivec2(near_low.y, near_high.y))
                                : (cell.x < 4 ? ivec2(near_low.z, near_high.z) : ivec2(near_low.w, near_high.w));
    int inside = 4 * (cell.x & 3) + 16 * (cell.y & 3);
    int first = 0, count = 0, next = 0, end = 0;
    if (low_high.x >= 0) {
      first = int(block_cells_at(65 * low_high.x + inside));
      count = int(block_cells_at(65 * low_high.x + inside + 4)) - first;
    }
    if (low_high.y >= 0) {
      next = int(block_cells_at(65 * low_high.y + inside));
      end = int(block_cells_at(65 * low_high.y + inside + 3));
    }
    int all_of_row = count + end - next;
    next -= count;
    vec4 piece_y = spline_piece((row & 3) - 2), piece_z = spline_piece((row >> 2) - 2);
    vec2 lowest = vec2(cell & 3);
    for (int i = 0; i < all_of_row; ++i) {
      bool in_low = i < count;
      int p = i + (in_low ? first : next);
      vec4 a = packed_particles_at(3 * p), b = packed_particles_at(3 * p + 1), c = packed_particles_at(3 * p + 2);
      float yz_stress = packed_stress_at(p);
      vec3 inside = a.xyz;
      vec2 y = spline_and_slope(piece_y, inside.y - lowest.x), z = spline_and_slope(piece_z, inside.z - lowest.y);
      float w = y.x * z.x, by_y = y.y * z.x, by_z = y.x * z.y;
      vec4 ux = inside.x + (in_low ? -2.0 : 2.0) - vec4(0.0, 1.0, 2.0, 3.0);
      vec4 wx = spline(ux), slope = spline_slope(ux);
      vec4 m = (a.w * w) * wx;
      slope *= w;
      mass_here += m;
      momentum_x += m * b.x;
      momentum_y += m * b.y;
      momentum_z += m * b.z;
      // stress * (slope w, wx by_y, wx by_z); rows of the stress: (b.w, c.z, c.w), (c.z, c.x, yz_stress), (c.w, yz_stress, c.y)
      force_x -= slope * b.w + wx * (c.z * by_y + c.w * by_z);
      force_y -= slope * c.z + wx * (c.x * by_y + yz_stress * by_z);
      force_z -= slope * c.w + wx * (yz_stress * by_y + c.y * by_z);
    }
  }

  int index = int(64u * slot + 4u * gl_LocalInvocationID.x);
  for (int i = 0; i < 4; ++i) {
    bool empty = !(mass_here[i] > 0.0);
    vec3 before = empty ? vec3(0.0) : vec3(momentum_x[i], momentum_y[i], momentum_z[i]) / mass_here[i];
    vec3 force = vec3(force_x[i], force_y[i], force_z[i]) * per_cell;
    grid_mass[index + i] = mass_here[i];
    grid_velocity_before[index + i] = before;
    grid_velocity[index + i] = empty ? vec3(0.0) : before + dt * (force / mass_here[i] + gravity);
  }
}
