// Mass and velocity of four nodes in a row along x, gathered from the particles of the 7 x 4 x 4 cells about them as in
// gather_velocities.comp: (m v)_i = sum w (m_p v_p + A_p (x_i - x_p)) (Jiang et al. 2015), A_p with the stress (Hu et al. 2018). No atomics:
// the order of the sums is fixed.
#define KERNEL_CUBIC 0
#include "lib/blocks.glsl"
#include "lib/bspline.glsl"

void main() {
  uint slot = group_number();
  if (slot >= active_block_count[0]) return;
  ivec2 yz = ivec2(gl_LocalInvocationID.x & 3u, gl_LocalInvocationID.x >> 2u);
  ivec4 near_low = block_near[4u * slot], near_high = block_near[4u * slot + 1u];

  // One component per node.
  vec4 mass_here = vec4(0.0), momentum_x = vec4(0.0), momentum_y = vec4(0.0), momentum_z = vec4(0.0);
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
    // (x_p - x_i) / h along y and z is the place in the block plus this.
    vec2 offset = vec2((row & 3) - 2, (row >> 2) - 2) - vec2(cell & 3);
    int i = 0;
    if (all_of_row > 0) do {  // the condition at the end: see gather_velocities.comp
      bool in_low = i < count;
      int p = 4 * (i + (in_low ? first : next));
      vec4 a = packed_affine_at(p), b = packed_affine_at(p + 1), c = packed_affine_at(p + 2), d = packed_affine_at(p + 3);
      vec2 uyz = a.yz + offset;
      float w = spline(uyz.x) * spline(uyz.y);
      vec4 ux = a.x + (in_low ? -2.0 : 2.0) - vec4(0.0, 1.0, 2.0, 3.0);
      vec4 wx = w * spline(ux);
      // m v - h A u, u = (ux, uyz); what is the same for all four first.
      vec3 same = b.xyz + uyz.x * vec3(c.zw, d.x) + uyz.y * d.yzw;
      mass_here += a.w * wx;
      momentum_x += wx * (same.x + b.w * ux);
      momentum_y += wx * (same.y + c.x * ux);
      momentum_z += wx * (same.z + c.y * ux);
    } while (++i < all_of_row);
  }

  int index = int(64u * slot + 4u * gl_LocalInvocationID.x);
  for (int i = 0; i < 4; ++i) {
    bool empty = !(mass_here[i] > 0.0);
    grid_mass[index + i] = mass_here[i];
    grid_velocity[index + i] = empty ? vec3(0.0) : vec3(momentum_x[i], momentum_y[i], momentum_z[i]) / mass_here[i] + dt * gravity;
  }
}
