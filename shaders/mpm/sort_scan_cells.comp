// Counting sort by cell, 4 of 6: where every cell's particles start. cell_start of the next cell of the row is a cell's end.
// A row that is empty and was empty keeps what it has: equal starts, so no cell of it holds anything.
#include "lib/grid.glsl"

void main() {
  uint row = element_index();
  if (row >= grid_rows_count) return;
  uint count = row_count[row];
  if (count == 0u && row_filled[row] == 0u) return;
  row_filled[row] = count;
  uint start = row_start[row];
  uint cell = row * uint(grid_nodes.x);
  for (int i = 0; i < grid_nodes.x; ++i, ++cell) {
    cell_start[cell] = start;
    start += cell_count[cell];
    cell_count[cell] = 0u;  // for the next sort
  }
}
