// What a cell adds to the sums of the body that displaces its snow, and of the body that it stands beside.
#include "heightfield/push_sums.glsl"
#include "lib/own_column.glsl"

uint lowest_body(int i) { return min(uint(owner[i]), uint(contour_owner[i])); }

void cell_addends(ivec2 cell, int i, out ivec4 bodies, out vec4 values) {
  int pushes = displaced[i] > 0.0 ? owner[i] : -1;
#if HAS_DISPLACED_HEIGHT
  bodies = ivec4(pushes, pushes, contour_owner[i], -1);
  values = vec4(displaced[i], displaced_height[i], contour_weight[i], 0.0);
#else
  bodies = ivec4(pushes, -1, contour_owner[i], -1);
  values = vec4(displaced[i], 0.0, contour_weight[i], 0.0);
#endif
}

#include "lib/column_sums.glsl"
