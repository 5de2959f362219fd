// What the neighbours of strictly higher distance hand to a cell, in equal parts to each of their lower ones.
#include "heightfield/lower.glsl"
#include "lib/cells.glsl"

vec2 handed_to(ivec2 cell) {
  float own = distance[cell_index(cell)];
  vec2 sum = vec2(0.0);
  for (int n = 0; n < neighbor_count; ++n) {
    ivec2 from = cell + neighbor_offsets[n];
    if (!in_field(from)) continue;
    int j = cell_index(from);
    if (lower_count[j] > 0u && strictly_lower(own, distance[j])) sum += travelling[j] / float(lower_count[j]);
  }
  return sum;
}
