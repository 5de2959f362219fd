// Each cell of a body's contour gets the share s / k_T of what the body displaces [H 3.25-3.28]; all the same where k_T = 0. Snow of a body
// without a contour, or without an owner, stays where it was.
#include "heightfield/push_sums.glsl"
#include "lib/own_cell.glsl"
#include "lib/body_sums.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell), around = contour_owner[i], body = owner[i];
  float mass = 0.0, height = 0.0;
  if (displaced[i] > 0.0 && (body < 0 || body >= int(bodies_count) || push_counts[4 * body + 2] == 0u)) {
    mass = displaced[i];
#if HAS_DISPLACED_HEIGHT
    height = displaced_height[i];
#endif
  }
  if (around >= 0 && around < int(bodies_count)) {
    float all = total(around, 2);
    float share = all > 0.0 ? contour_weight[i] / all : 1.0 / float(push_counts[4 * around + 2]);
    mass += share * total(around, 0);
    height += share * total(around, 1);
  }
  arrived[i] = mass;
#if HAS_ARRIVED_HEIGHT
  arrived_height[i] = height;
#endif
}
