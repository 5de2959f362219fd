// What cells in the overlap have to hand on, to how many, and from how many they get some; a list of those that get none.
#include "heightfield/lower.glsl"
#include "lib/own_cell.glsl"

// 1 in x where `to` is lower than a cell of this distance, in y where it is higher and hands on.
ivec2 compared(ivec2 to, float own) {
  if (!in_field(to)) return ivec2(0);
  float other = distance[cell_index(to)];
  return ivec2(strictly_lower(other, own), strictly_lower(own, other) && other < infinity);
}

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  float own = distance[i];
  ivec2 lower_and_higher = ivec2(0);
  if (own > 0.0 && own < infinity) {
#define COMPARE(n) lower_and_higher += compared(cell + neighbor_offsets[n], own);
    FOR_RECEIVERS(COMPARE)
  }
  lower_count[i] = uint(lower_and_higher.x);
  higher_left[i] = uint(lower_and_higher.y);
#if HAS_DISPLACED_HEIGHT
  travelling[i] = vec2(displaced[i], displaced_height[i]);
#else
  travelling[i] = vec2(displaced[i], 0.0);
#endif
  if (lower_and_higher.x > 0 && lower_and_higher.y == 0) leaving[atomicAdd(leaving_count[0], 1u)] = uint(i);
}
