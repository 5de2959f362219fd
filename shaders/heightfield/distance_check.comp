// Lists the cells that have a cheaper way than found so far.
#include "heightfield/distance_way.glsl"
#include "lib/own_cell.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  float before = distance[i];
  if (before > 0.0 && cheapest_way(cell, owner[i]) < before) waiting[atomicAdd(waiting_count[0], 1u)] = uint(i);
}
