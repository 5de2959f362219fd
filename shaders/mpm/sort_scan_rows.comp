// Counting sort by cell, 3 of 6: exclusive prefix sum over rows of cells, by one group: every invocation sums a run of rows, then those
// sums are scanned.
shared uint sums[256];

void main() {
  uint lane = gl_LocalInvocationID.x;
  uint run = (grid_rows_count + 255u) / 256u;
  uint first = lane * run, last = min(first + run, grid_rows_count);
  uint sum = 0u;
  for (uint row = first; row < last; ++row) sum += row_count[row];
  sums[lane] = sum;
  barrier();
  for (uint reach = 1u; reach < 256u; reach *= 2u) {
    uint below = lane >= reach ? sums[lane - reach] : 0u;
    barrier();
    sums[lane] += below;
    barrier();
  }
  uint start = sums[lane] - sum;
  for (uint row = first; row < last; ++row) {
    row_start[row] = start;
    start += row_count[row];
  }
}
