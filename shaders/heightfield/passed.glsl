// What the neighbours of strictly higher distance hand to a cell, in equal parts to each of their lower ones.
#include "heightfield/lower.glsl"

vec2 handed_from(ivec2 from, float own) {
  if (!in_field(from)) return vec2(0.0);
  int j = cell_index(from);
  if (lower_count[j] == 0u || !strictly_lower(own, distance[j])) return vec2(0.0);
  return travelling[j] / float(lower_count[j]);
}

vec2 handed_to(ivec2 cell) {
  float own = distance[cell_index(cell)];
  vec2 sum = vec2(0.0);
#define HANDED(n) sum += handed_from(cell + neighbor_offsets[n], own);
  FOR_RECEIVERS(HANDED)
  return sum;
}
