// Counting sort by cell, 1 of 6: no row has particles.
void main() {
  uint row = element_index();
  if (row < grid_rows_count) row_count[row] = 0u;
}
