// 0 outside the overlap, infinite in it; a list of the latter.
#include "lib/own_cell.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  bool is_covered = overlap[i] > 0.0 && owner[i] >= 0 && owner[i] < int(bodies_count);
  distance[i] = is_covered ? infinity : 0.0;
  woken[i] = 0u;
  if (is_covered) covered[atomicAdd(covered_count[0], 1u)] = uint(i);
}
