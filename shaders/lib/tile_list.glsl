// A list of tiles, and the size of a dispatch with one group for each, made by a single group of 1024. Before including: TILE_LIST and
// TILE_GROUPS name the buffers, and bool listed(uint tile) says which.
// More than 32768 groups are folded into two axes; the places that this adds at the end of the list hold no_tile.

shared uint listed_count;

void list_tiles() {
  uint lane = gl_LocalInvocationID.x;
  if (lane == 0u) listed_count = 0u;
  barrier();
  for (uint tile = lane; tile < tiles_count; tile += gl_WorkGroupSize.x)
    if (listed(tile)) TILE_LIST[atomicAdd(listed_count, 1u)] = tile;
  barrier();
  uint count = listed_count, rows = max((count + 32767u) / 32768u, 1u), columns = (count + rows - 1u) / rows;
  if (lane < rows * columns - count && count + lane < tiles_count) TILE_LIST[count + lane] = no_tile;
  if (lane == 0u) {
    TILE_GROUPS[0] = columns;
    TILE_GROUPS[1] = rows;
    TILE_GROUPS[2] = 1u;
  }
}
