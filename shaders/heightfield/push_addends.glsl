#include "heightfield/push_sums.glsl"
#include "lib/own_cell.glsl"
#include "lib/body_sums.glsl"

void for_each_addend() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell), body = owner[i], around = contour_owner[i];
  if (displaced[i] > 0.0 && body >= 0 && body < int(bodies_count)) {
    EACH(body, 0, displaced[i]);
#if HAS_DISPLACED_HEIGHT
    EACH(body, 1, displaced_height[i]);
#endif
  }
  if (around >= 0 && around < int(bodies_count)) EACH(around, 2, contour_weight[i]);
}

void main() { for_each_addend(); }
