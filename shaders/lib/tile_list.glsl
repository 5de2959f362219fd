// A list of tiles that grows as invocations come, and the size of a dispatch with one group for each. Before including: TILE_LIST, TILE_COUNT and
// TILE_GROUPS name the buffers.

void list_tile(uint tile) { TILE_LIST[atomicAdd(TILE_COUNT[0], 1u)] = tile; }

// Once the list is complete, by one group: more than 32768 groups are folded into two axes; the places that this adds at the end of the list
// hold no_tile. The next list begins empty.
#ifdef TILE_GROUPS
void size_tile_groups() {
  uint lane = gl_LocalInvocationID.x, count = min(TILE_COUNT[0], tiles_count), rows = max((count + 32767u) / 32768u, 1u), columns = (count + rows - 1u) / rows;
  barrier();
  if (lane < rows * columns - count && count + lane < tiles_count) TILE_LIST[count + lane] = no_tile;
  if (lane == 0u) {
    TILE_GROUPS[0] = columns;
    TILE_GROUPS[1] = rows;
    TILE_GROUPS[2] = 1u;
    TILE_COUNT[0] = 0u;
  }
}
#endif
