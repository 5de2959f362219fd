// 0 outside the overlap, infinite in it; and the rectangle of cells that each body covers.
#include "lib/own_cell.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell), body = owner[i];
  bool is_covered = overlap[i] > 0.0 && body >= 0 && body < int(bodies_count);
  distance[i] = is_covered ? infinity : 0.0;
  woken[i] = 0u;
  if (!is_covered) return;
  // Most cells lie within what others have found.
#define REACH(side, value, better, widen) \
  if (covered_reach[4 * body + side] better uint(value)) widen(covered_reach[4 * body + side], uint(value));
  REACH(0, cell.x, >, atomicMin)
  REACH(1, cell.y, >, atomicMin)
  REACH(2, cell.x, <, atomicMax)
  REACH(3, cell.y, <, atomicMax)
}
