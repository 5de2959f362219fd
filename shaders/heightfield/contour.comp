// Cells without overlap beside cells with it, and how strongly the body pushes there [H 3.20-3.24]. Each body is taken by itself: its
// overlap is D where it owns the cell and 0 elsewhere, also outside the field. A cell beside several bodies goes to the one that pushes
// most there, to the first of equals.
#include "lib/direction.glsl"
#include "lib/own_cell.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell), best_owner = -1;
  float best = 0.0;
  if (!(overlap_at(i) > 0.0)) {
    float d[8];
    int body[8];
    for (int n = 0; n < 8; ++n) {
      ivec2 at = cell + neighbor_offsets[n];
      d[n] = 0.0;
      body[n] = -1;
      if (!in_field(at)) continue;
      d[n] = overlap_at(cell_index(at));
      if (d[n] > 0.0) body[n] = owner_at(cell_index(at));
    }
    for (int n = 0; n < 8; ++n) {
      int b = body[n];
      if (b < 0 || b >= int(bodies_count)) continue;
      // Minus the Sobel gradient, weights 1 2 1: outward.
      vec2 outward = vec2(0.0);
      for (int m = 0; m < 8; ++m)
        if (body[m] == b) outward -= (m < 4 ? 2.0 : 1.0) * d[m] * vec2(neighbor_offsets[m]);
      float size = length(outward);
      float s = direction_factor(body_velocity[b], size > 0.0 ? outward / size : vec2(0.0));
      if (best_owner < 0 || s > best || (s == best && b < best_owner)) {
        best = s;
        best_owner = b;
      }
    }
  }
  contour_weight[i] = best;
  contour_owner[i] = best_owner;
}
