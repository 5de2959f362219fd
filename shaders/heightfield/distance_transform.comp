// The cheapest way out of the overlap: exact for any shapes and costs. All covered cells look at their neighbours once; then, turn by turn,
// those beside which something has become cheaper, until nothing does. A single group, so that every turn sees the one before. A step costs
// what the body that owns the cell it leaves makes it cost.
#include "lib/cells.glsl"

shared uint next_count;

float way_by(ivec2 to, float step_cost) { return in_field(to) ? distance[cell_index(to)] + step_cost : infinity; }

// Puts a cell that may gain on the list of the next turn, once.
void wake(ivec2 to, float reached, uint turn) {
  if (!in_field(to)) return;
  int j = cell_index(to);
  if (!(distance[j] > reached) || woken[j] == turn || atomicExchange(woken[j], turn) == turn) return;
  waiting[(turn & 1u) * cells_count + atomicAdd(next_count, 1u)] = uint(j);
}

void main() {
  uint lane = gl_LocalInvocationID.x, all = min(covered_count[0], cells_count), count = all;
  // A cheapest way has no cell twice.
  for (uint turn = 1u; turn <= all + 1u && count > 0u; ++turn) {
    barrier();
    if (lane == 0u) next_count = 0u;
    barrier();
    for (uint entry = lane; entry < count; entry += gl_WorkGroupSize.x) {
      int i = int(turn == 1u ? covered[entry] : waiting[(turn - 1u & 1u) * cells_count + entry]), body = owner[i];
      ivec2 cell = cell_at(uint(i));
      vec4 straight = step_costs[2 * body], diagonal = step_costs[2 * body + 1];
      float before = distance[i], best = before;
#define LOOK(n) best = min(best, way_by(cell + neighbor_offsets[n], n < 4 ? straight[n & 3] : diagonal[n & 3]));
      FOR_NEIGHBORS(LOOK)
      if (best < before) {
        distance[i] = best;
#define WAKE(n) wake(cell + neighbor_offsets[n], best, turn);
        FOR_NEIGHBORS(WAKE)
      }
    }
    memoryBarrierBuffer();
    barrier();
    count = next_count;
  }
  if (lane == 0u) covered_count[0] = 0u;
}
