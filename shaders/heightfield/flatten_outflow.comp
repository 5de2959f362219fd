// How much snow every cell gives to each of its receivers [H 3.29-3.33]: those of its 8 neighbours that are lower and have no body in the way.
#include "heightfield/flatten_cell.glsl"

float drop_to(ivec2 to, float height) {
  if (!in_field(to)) return 0.0;
  int j = cell_index(to);
  return height - (ground_at(j) + depth_at(j));
}

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  float snow = depth_at(i), height = ground_at(i) + snow;
  float each = 0.0;
  int receivers = 0;
  if (snow > 0.0) {
    float steepest = slope > 0.0 ? slope : material_slope;
    float straight = steepest * field_cell;
#if DIAGONAL_EUCLIDEAN
    float diagonal_rise = steepest * field_cell * sqrt(2.0);
#else
    float diagonal_rise = straight;
#endif
#define RISE(n) (n < 4 ? straight : diagonal_rise)
#define DROP(n) float drop##n = drop_to(cell + neighbor_offsets[n], height);
    FOR_NEIGHBORS(DROP)
    float excess = 0.0, steep = 0.0;
#define EXCESS(n) float excess##n = drop##n - RISE(n);
    FOR_NEIGHBORS(EXCESS)
#define STEEPEST(n) excess = max(excess, excess##n);
    FOR_NEIGHBORS(STEEPEST)
    if (excess > 0.0) {
      excess = 0.0;
#define RECEIVE(n)                                                                                      \
  if (drop##n > tie && height < underside_at(cell_index(cell + neighbor_offsets[n]))) {                 \
    receivers |= 1 << n;                                                                                \
    excess += max(excess##n, 0.0);                                                                      \
    steep += excess##n > 0.0 ? 1.0 : 0.0;                                                               \
  }
      FOR_NEIGHBORS(RECEIVE)
      float given = steep > 0.0 ? min(relaxation * excess / steep, snow) : 0.0;
      if (given > quiet * field_cell) {
        each = given / float(bitCount(receivers));
        atomicMax(moved_bits[0], floatBitsToUint(given));
      } else {
        receivers = 0;
      }
    }
  }
  outflow[i] = vec2(each, float(receivers));
}
