#include "heightfield/ways.glsl"

// What is handed to a cell: by every giver the same as to its other receivers.
vec2 handed_to(ivec2 cell, uint way) {
  vec2 sum = vec2(0.0);
#define HANDED(n) if ((way >> (n + givers_shift) & 1u) != 0u) sum += travelling[cell_index(cell + neighbor_offsets[n])];
  FOR_NEIGHBORS(HANDED)
  return sum;
}
