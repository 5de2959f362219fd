// What cells in the overlap have to hand on, to how many, and a list of those that can.
#include "heightfield/lower.glsl"
#include "lib/own_cell.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  float own = distance[i];
  uint lower = 0u;
  if (own > 0.0 && own < infinity)
    for (int n = 0; n < neighbor_count; ++n) {
      ivec2 to = cell + neighbor_offsets[n];
      if (in_field(to) && strictly_lower(distance[cell_index(to)], own)) ++lower;
    }
  lower_count[i] = lower;
#if HAS_DISPLACED_HEIGHT
  travelling[i] = vec2(displaced[i], displaced_height[i]);
#else
  travelling[i] = vec2(displaced[i], 0.0);
#endif
  if (own > 0.0) leaving[atomicAdd(leaving_count[0], 1u)] = uint(i);
}
