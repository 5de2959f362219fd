// The cheapest way out of the overlap, by repeated relaxation of all covered cells until none changes: exact for any shapes and costs. A
// single group, so that every turn sees the one before. A step costs what the body that owns the cell it leaves makes it cost.
#include "lib/cells.glsl"

shared uint improved;

void main() {
  uint lane = gl_LocalInvocationID.x, count = min(covered_count[0], cells_count);
  // A cheapest way has no cell twice.
  for (uint turn = 0u; turn <= count; ++turn) {
    barrier();
    if (lane == 0u) improved = 0u;
    barrier();
    for (uint entry = lane; entry < count; entry += gl_WorkGroupSize.x) {
      int i = int(covered[entry]), body = owner[i];
      ivec2 cell = cell_at(uint(i));
      float costs[8] = float[8](step_costs[2 * body].x, step_costs[2 * body].y, step_costs[2 * body].z, step_costs[2 * body].w,
                                step_costs[2 * body + 1].x, step_costs[2 * body + 1].y, step_costs[2 * body + 1].z, step_costs[2 * body + 1].w);
      float before = distance[i], best = before;
      for (int n = 0; n < 8; ++n) {
        ivec2 to = cell + neighbor_offsets[n];
        if (in_field(to)) best = min(best, distance[cell_index(to)] + costs[n]);
      }
      if (best < before) {
        distance[i] = best;
        improved = 1u;
      }
    }
    memoryBarrierBuffer();
    barrier();
    if (improved == 0u) break;
  }
  barrier();
  if (lane == 0u) covered_count[0] = 0u;
}
