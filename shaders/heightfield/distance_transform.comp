// The cheapest way out of the overlap, exact for any shapes and costs: turn by turn, cells that may gain look at their neighbours, and wake
// those for which that makes something cheaper, until nothing does. A single group, so that every turn sees the one before.
#include "heightfield/distance_way.glsl"

shared uint next_count;

// Puts a cell that may gain on the list of the next turn, once.
void wake(ivec2 to, float reached, uint turn) {
  if (!in_field(to)) return;
  int j = cell_index(to);
  if (!(distance[j] > reached) || woken[j] == turn || atomicExchange(woken[j], turn) == turn) return;
  waiting[(turn & 1u) * cells_count + atomicAdd(next_count, 1u)] = uint(j);
}

void main() {
  uint lane = gl_LocalInvocationID.x, count = min(waiting_count[0], cells_count);
  // A cheapest way has no cell twice.
  for (uint turn = 1u; turn <= cells_count && count > 0u; ++turn) {
    barrier();
    if (lane == 0u) next_count = 0u;
    barrier();
    for (uint entry = lane; entry < count; entry += gl_WorkGroupSize.x) {
      int i = int(waiting[(turn - 1u & 1u) * cells_count + entry]);
      ivec2 cell = cell_at(uint(i));
      float best = cheapest_way(cell, owner[i]);
      if (best < distance[i]) {
        distance[i] = best;
#define WAKE(n) wake(cell + neighbor_offsets[n], best, turn);
        FOR_NEIGHBORS(WAKE)
      }
    }
    memoryBarrierBuffer();
    barrier();
    count = next_count;
  }
  if (lane == 0u) waiting_count[0] = 0u;
}
