// What comes out of the overlap arrives; what finds no way out stays.
#include "heightfield/passed.glsl"
#include "lib/own_cell.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  uint own = ways[i];
  vec2 amount = vec2(0.0);
  if (!(distance[i] > 0.0)) amount = travelling[i] + handed_to(cell, own);
  else if (receivers_of(own) == 0u) amount = travelling[i];
  arrived[i] = amount.x;
#if HAS_ARRIVED_HEIGHT
  arrived_height[i] = amount.y;
#endif
}
