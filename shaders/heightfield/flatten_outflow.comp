// How much snow every cell gives to each of its receivers [H 3.29-3.33]: those of its 8 neighbours that are lower and have no body in the way.
// An invocation goes up a column of cells and keeps what it has read.
#define OWN_TILES flatten_tiles
#include "lib/own_column.glsl"

// Of three cells side by side: surfaces and undersides. Outside the field all is too high to receive.
struct Row {
  vec3 height, below;
};

Row row_of(ivec2 middle) {
  Row row = Row(vec3(infinity), vec3(infinity));
#define READ(k)                                                     \
  {                                                                 \
    ivec2 cell = middle + ivec2(k - 1, 0);                          \
    int i = cell_index(clamp(cell, ivec2(0), ivec2(cells_width, cells_height) - 1)); \
    float height = ground_at(i) + depth_at(i), below = underside_at(i); \
    if (in_field(cell)) row.height[k] = height;                     \
    row.below[k] = below;                                           \
  }
  READ(0) READ(1) READ(2)
  return row;
}

// What a cell of this depth in the middle of three rows gives; to whom, one bit each.
vec2 outflow_of(float snow, Row low, Row own, Row high) {
  float height = own.height.y;
  float steepest = slope > 0.0 ? slope : material_slope;
  float straight = steepest * field_cell;
#if DIAGONAL_EUCLIDEAN
  float diagonal_rise = steepest * field_cell * sqrt(2.0);
#else
  float diagonal_rise = straight;
#endif
  // In the order of neighbor_offsets.
  vec4 drop_0 = height - vec4(own.height.x, own.height.z, low.height.y, high.height.y);
  vec4 drop_4 = height - vec4(low.height.x, low.height.z, high.height.x, high.height.z);
  vec4 below_0 = vec4(own.below.x, own.below.z, low.below.y, high.below.y), below_4 = vec4(low.below.x, low.below.z, high.below.x, high.below.z);
  vec4 excess_0 = drop_0 - straight, excess_4 = drop_4 - diagonal_rise;
  vec4 most = max(excess_0, excess_4);
  if (!(snow > 0.0) || !(max(max(most.x, most.y), max(most.z, most.w)) > 0.0)) return vec2(0.0);
  float excess = 0.0, steep = 0.0;
  int receivers = 0;
#define RECEIVE(n)                                                       \
  if (drop_##n > tie && height < below_##n) {                            \
    receivers |= 1 << bit;                                               \
    excess += max(excess_##n, 0.0);                                      \
    steep += excess_##n > 0.0 ? 1.0 : 0.0;                               \
  }                                                                      \
  ++bit;
  int bit = 0;
  RECEIVE(0.x) RECEIVE(0.y) RECEIVE(0.z) RECEIVE(0.w) RECEIVE(4.x) RECEIVE(4.y) RECEIVE(4.z) RECEIVE(4.w)
  float given = steep > 0.0 ? min(relaxation * excess / steep, snow) : 0.0;
  if (!(given > quiet * field_cell)) return vec2(0.0);
  atomicMax(moved_bits[0], floatBitsToUint(given));
  return vec2(given / float(bitCount(receivers)), float(receivers));
}

void main() {
  ivec2 cell;
  if (!own_column(cell)) return;
  Row low = row_of(cell - ivec2(0, 1)), own = row_of(cell);
  int done = 0;
  do {
    Row high = row_of(cell + ivec2(0, 1));
    if (in_field(cell)) {
      int i = cell_index(cell);
      outflow[i] = outflow_of(depth_at(i), low, own, high);
    }
    low = own;
    own = high;
    ++cell.y;
  } while (++done < column_cells);
}
