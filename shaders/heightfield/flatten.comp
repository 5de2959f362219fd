// Takes what every cell gives and adds what its neighbours give it, at their density [H 3.33]. A cell without snow takes the density of what
// arrives. An invocation goes up a column of cells and keeps what it has read.
#define OWN_TILES flatten_tiles
#include "lib/own_column.glsl"
#include "lib/unbiased.glsl"

// Of three cells side by side: the height and the mass that each gives to every one of its receivers, and these, one bit each.
struct Row {
  vec3 height, mass;
  ivec3 receivers;
};

Row row_of(ivec2 middle) {
  Row row;
#define READ(k)                                                                    \
  {                                                                                \
    ivec2 cell = middle + ivec2(k - 1, 0);                                         \
    int i = cell_index(clamp(cell, ivec2(0), ivec2(cells_width, cells_height) - 1)); \
    vec2 gives = outflow_at(i);                                                    \
    row.receivers[k] = in_field(cell) ? int(gives.y) : 0;                          \
    row.height[k] = gives.x;                                                       \
    /* A giver had snow, so that nobody changes its density now. */                \
    row.mass[k] = row.receivers[k] != 0 ? gives.x * density[i] : 0.0;              \
  }
  READ(0) READ(1) READ(2)
  return row;
}

void main() {
  if (element_index() == 0u) moved[0] = uintBitsToFloat(moved_bits[0]);
  ivec2 cell;
  if (!own_column(cell)) return;
#if CELLS_ACTIVE
  uint tile = tile_of(cell);
#endif
  Row low = row_of(cell - ivec2(0, 1)), own = row_of(cell);
  int done = 0;
  bool gave = false;
  do {
    Row high = row_of(cell + ivec2(0, 1));
    float given = own.height.y * float(bitCount(own.receivers.y));
    vec2 arrived = vec2(0.0);  // mass, height
#define TAKE(n, row, k) \
  if ((row.receivers[k] >> opposite_neighbor[n] & 1) != 0) arrived += vec2(row.mass[k], row.height[k]);
    TAKE(0, own, 0) TAKE(1, own, 2) TAKE(2, low, 1) TAKE(3, high, 1) TAKE(4, low, 0) TAKE(5, low, 2) TAKE(6, high, 0) TAKE(7, high, 2)
    if (in_field(cell) && (given != 0.0 || arrived.y != 0.0)) {
      int i = cell_index(cell);
      float before = depth[i];
      if (arrived.x > 0.0 && !(before > 0.0)) density[i] = arrived.x / arrived.y;
      float gained = arrived.x > 0.0 ? arrived.x / density[i] : 0.0;
      depth[i] = max(unbiased_sum(before, gained - given, i), 0.0);
      gave = gave || given > 0.0;
    }
    low = own;
    own = high;
    ++cell.y;
  } while (++done < column_cells);
#if CELLS_ACTIVE
  // A tile that gave is listed again, so that nobody ever takes an old outflow for a new one.
  if (gave) changed_tiles[tile] = 1u;
#endif
}
