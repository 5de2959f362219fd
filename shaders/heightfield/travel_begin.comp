// What cells in the overlap have to hand on, to which neighbours, and from which they get some; a list of those that get none. Distances that
// are equal within a relative 1e-6 count as equal.
#include "heightfield/ways.glsl"
#include "lib/own_cell.glsl"

bool strictly_lower(float a, float b) { return a < b * (1.0 - 1.0e-6); }

// The bits of neighbour n.
uint way(ivec2 to, int n, float own) {
  if (!in_field(to)) return 0u;
  float other = distance[cell_index(to)];
  if (own < infinity && strictly_lower(other, own)) return 1u << n;
  return other < infinity && strictly_lower(own, other) ? (1u << n + givers_shift) + (1u << givers_left_shift) : 0u;
}

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  float own = distance[i];
  uint all = 0u;
#define WAY(n) all += way(cell + neighbor_offsets[n], n, own);
#if NEIGHBOURS_4
  WAY(0) WAY(1) WAY(2) WAY(3)
#else
  FOR_NEIGHBORS(WAY)
#endif
  // Outside, nobody waits for what is handed to the cell.
  if (!(own > 0.0)) all &= 0xffffu;
  ways[i] = all;
#if HAS_DISPLACED_HEIGHT
  vec2 amount = vec2(displaced[i], displaced_height[i]);
#else
  vec2 amount = vec2(displaced[i], 0.0);
#endif
  travelling[i] = amount;
  if (receivers_of(all) > 0u && all >> givers_left_shift == 0u) leaving[atomicAdd(leaving_count[0], 1u)] = uint(i);
}
