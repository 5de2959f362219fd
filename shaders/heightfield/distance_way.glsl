// The cheapest way out from a cell, by what its neighbours have so far. A step costs what the body that owns the cell it leaves makes it cost.
#include "lib/cells.glsl"

float way_by(ivec2 to, float step_cost) { return in_field(to) ? distance[cell_index(to)] + step_cost : infinity; }

float cheapest_way(ivec2 cell, int body) {
  vec4 straight = step_costs[2 * body], diagonal = step_costs[2 * body + 1];
  float best = infinity;
#define LOOK(n) best = min(best, way_by(cell + neighbor_offsets[n], n < 4 ? straight[n & 3] : diagonal[n & 3]));
  FOR_NEIGHBORS(LOOK)
  return best;
}
