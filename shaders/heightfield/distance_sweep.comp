// One group per body: goes over the cells under it four times, once towards each side, row by row (or column by column) away from the way out;
// every cell looks at the three neighbours in the row before. Under a body without holes or bays that finds all cheapest ways: they consist of
// steps in two directions next to each other, which have one of the four sides in common. What is left is for distance_transform.
#include "lib/cells.glsl"

float way_by(ivec2 to, float step_cost) { return in_field(to) ? distance[cell_index(to)] + step_cost : infinity; }

void main() {
  int body = int(group_number());
  if (body >= int(bodies_count)) return;
  ivec2 low = ivec2(covered_reach[4 * body], covered_reach[4 * body + 1]), high = ivec2(covered_reach[4 * body + 2], covered_reach[4 * body + 3]);
  if (any(greaterThan(low, high)) || any(lessThan(low, ivec2(0)))) return;
  vec4 straight = step_costs[2 * body], diagonal = step_costs[2 * body + 1];
  for (int side = 0; side < 4; ++side) {
    if (!(straight[side] < infinity)) continue;  // then the diagonals are infinite, too
    bool along_x = side < 2, ascending = (side & 1) == 0;
    ivec2 out_ = along_x ? ivec2(ascending ? -1 : 1, 0) : ivec2(0, ascending ? -1 : 1), across = along_x ? ivec2(0, 1) : ivec2(1, 0);
    vec2 diagonals = side == 0 ? diagonal.xz : side == 1 ? diagonal.yw : side == 2 ? diagonal.xy : diagonal.zw;
    int rows = along_x ? high.x - low.x + 1 : high.y - low.y + 1, length_ = along_x ? high.y - low.y + 1 : high.x - low.x + 1;
    ivec2 first = ascending ? low : along_x ? ivec2(high.x, low.y) : ivec2(low.x, high.y);
    for (int row = 0; row < rows; ++row) {
      int place = int(gl_LocalInvocationID.x);
      if (place < length_) do {
        ivec2 cell = first - row * out_ + place * across;
        int i = cell_index(cell);
        float before = distance[i];
        float best = min(way_by(cell + out_, straight[side]), min(way_by(cell + out_ - across, diagonals.x), way_by(cell + out_ + across, diagonals.y)));
        if (best < before && owner[i] == body) distance[i] = best;
        place += int(gl_WorkGroupSize.x);
      } while (place < length_);
      memoryBarrierBuffer();
      barrier();
    }
  }
}
