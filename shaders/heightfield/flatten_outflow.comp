// How much snow every cell gives to each of its receivers [H 3.29-3.33]: those of its 8 neighbours that are lower and have no body in the way.
#include "heightfield/flatten_cell.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  float snow = depth_at(i), height = ground_at(i) + snow;
  float each = 0.0;
  uint receivers = 0u;
  if (snow > 0.0) {
    float steepest = slope > 0.0 ? slope : material_slope;
    float straight = steepest * field_cell;
#if DIAGONAL_EUCLIDEAN
    float diagonal_rise = steepest * field_cell * sqrt(2.0);
#else
    float diagonal_rise = straight;
#endif
    float drops[8];
    bool any_steep = false;
    for (int n = 0; n < 8; ++n) {
      ivec2 to = cell + neighbor_offsets[n];
      drops[n] = 0.0;
      if (!in_field(to)) continue;
      int j = cell_index(to);
      drops[n] = height - (ground_at(j) + depth_at(j));
      any_steep = any_steep || drops[n] > (n < 4 ? straight : diagonal_rise);
    }
    if (any_steep) {
      float excess = 0.0;
      int steep = 0;
      for (int n = 0; n < 8; ++n) {
        if (!(drops[n] > tie)) continue;
        if (height >= underside_at(cell_index(cell + neighbor_offsets[n]))) continue;
        receivers |= 1u << uint(n);
        float e = drops[n] - (n < 4 ? straight : diagonal_rise);
        if (e > 0.0) {
          excess += e;
          ++steep;
        }
      }
      float given = steep > 0 ? min(relaxation * excess / float(steep), snow) : 0.0;
      if (given > quiet * field_cell) {
        each = given / float(bitCount(receivers));
        atomicMax(moved_bits[0], floatBitsToUint(given));
      } else {
        receivers = 0u;
      }
    }
  }
  outflow[i] = each;
  outflow_to[i] = receivers;
}
