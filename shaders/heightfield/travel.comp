// From the highest level down, every cell hands on what it has, its own and what came. Here all cells at once, again and again until
// nothing changes: after n turns everything that is at most n cells from the highest levels is final. A single group, so that every turn
// sees the one before.
#include "heightfield/passed.glsl"

shared uint altered;

void main() {
  uint lane = gl_LocalInvocationID.x, count = min(leaving_count[0], cells_count);
  for (uint turn = 0u; turn <= count; ++turn) {
    barrier();
    if (lane == 0u) altered = 0u;
    barrier();
    for (uint entry = lane; entry < count; entry += gl_WorkGroupSize.x) {
      int i = int(leaving[entry]);
#if HAS_DISPLACED_HEIGHT
      vec2 own = vec2(displaced[i], displaced_height[i]);
#else
      vec2 own = vec2(displaced[i], 0.0);
#endif
      vec2 before = travelling[i], after = own + handed_to(cell_at(uint(i)));
      if (any(lessThan(before, after)) || any(greaterThan(before, after))) {
        travelling[i] = after;
        altered = 1u;
      }
    }
    memoryBarrierBuffer();
    barrier();
    if (altered == 0u) break;
  }
  barrier();
  if (lane == 0u) leaving_count[0] = 0u;
}
