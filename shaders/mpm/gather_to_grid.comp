// Mass, momentum and force of a node, gathered from the particles of the 4 x 4 x 4 cells about it [M 3.4 steps 1, 3]. Rows of cells hold
// their particles one after another, so there are 16 runs to read. No atomics: the order of the sum is fixed.
#include "lib/grid.glsl"
#include "lib/bspline.glsl"

void main() {
  uint i = element_index();
  if (i >= nodes_count) return;
  ivec3 node = node_of(i);
  ivec3 low = max(node - 2, ivec3(0)), high = min(node + 1, grid_nodes - 2);
  float mass_here = 0.0;
  vec3 momentum = vec3(0.0), force = vec3(0.0);
  float per_cell = 1.0 / grid_cell;
  vec3 offset = -grid_min * per_cell - vec3(node);
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y) {
      int first = int(cell_start_at(node_index(ivec3(low.x, y, z))));
      int end = int(cell_start_at(node_index(ivec3(high.x + 1, y, z))));
      for (int slot = first; slot < end; ++slot) {
        int particle = int(order_at(slot));
        vec3 u = position_at(particle) * per_cell + offset;
        vec3 w = vec3(spline(u.x), spline(u.y), spline(u.z));
        vec3 gradient = vec3(spline_slope(u.x) * w.y * w.z, w.x * spline_slope(u.y) * w.z, w.x * w.y * spline_slope(u.z));
        float m = mass_at(particle) * w.x * w.y * w.z;
        mass_here += m;
        momentum += m * velocity_at(particle);
        force -= stress_at(particle) * gradient;
      }
    }
  grid_mass_sum[i] = mass_here;
  grid_momentum_sum[i] = momentum;
  grid_force_sum[i] = force * per_cell;
}
