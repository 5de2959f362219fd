// From the highest level down, every cell hands on what it has, its own and what came, in equal parts: as soon as all that hand it something
// have done so. Each cell comes once, in the order of the list, which grows while it is worked on. A single group, so that every turn sees the
// one before.
#include "heightfield/passed.glsl"

shared uint end_of_list;

void tell(ivec2 to) {
  int j = cell_index(to);
  if (atomicAdd(ways[j], 0u - (1u << givers_left_shift)) >> givers_left_shift == 1u) leaving[atomicAdd(end_of_list, 1u)] = uint(j);
}

void main() {
  uint lane = gl_LocalInvocationID.x, begin = 0u, end = min(leaving_count[0], cells_count);
  if (lane == 0u) end_of_list = end;
  barrier();
  while (begin < end) {
    uint entry = begin + lane;
    if (entry < end) do {
      int i = int(leaving[entry]);
      ivec2 cell = cell_at(uint(i));
      uint own = ways[i];
      travelling[i] = (travelling[i] + handed_to(cell, own)) / float(max(receivers_of(own), 1u));
#define TELL(n) if ((own >> n & 1u) != 0u) tell(cell + neighbor_offsets[n]);
      FOR_NEIGHBORS(TELL)
      entry += gl_WorkGroupSize.x;
    } while (entry < end);
    memoryBarrierBuffer();
    barrier();
    begin = end;
    end = min(end_of_list, cells_count);
    barrier();
  }
  if (lane == 0u) leaving_count[0] = 0u;
}
