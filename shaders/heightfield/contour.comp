// Cells without overlap beside cells with it, and how strongly the body pushes there [H 3.20-3.24]. Each body is taken by itself: its
// overlap is D where it owns the cell and 0 elsewhere, also outside the field. A cell beside several bodies goes to the one that pushes
// most there, to the first of equals.
#include "lib/direction.glsl"
#include "lib/own_cell.glsl"

// Of a neighbour: the body that overlaps it, -1: none; and how deep.
struct Overlap {
  int body;
  float depth;
};

Overlap overlap_of(ivec2 cell) {
  Overlap found = Overlap(-1, 0.0);
  if (!in_field(cell)) return found;
  found.depth = overlap_at(cell_index(cell));
  if (found.depth > 0.0) found.body = owner_at(cell_index(cell));
  if (found.body >= int(bodies_count)) found.body = -1;
  return found;
}

// A part of minus the Sobel gradient of one body's overlap, weights 1 2 1: outward.
vec2 slope_part(Overlap at, int body, int n) {
  return at.body == body ? -(n < 4 ? 2.0 : 1.0) * at.depth * vec2(neighbor_offsets[n]) : vec2(0.0);
}

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell), best_owner = -1;
  float best = 0.0;
  if (!(overlap_at(i) > 0.0)) {
#define LOOK(n) Overlap at##n = overlap_of(cell + neighbor_offsets[n]);
    FOR_NEIGHBORS(LOOK)
    ivec4 straight = ivec4(at0.body, at1.body, at2.body, at3.body), diagonal = ivec4(at4.body, at5.body, at6.body, at7.body);
    for (int n = 0; n < 8; ++n) {
      int b = n < 4 ? straight[n] : diagonal[n - 4];
      if (b < 0 || b == best_owner) continue;
      vec2 outward = slope_part(at0, b, 0) + slope_part(at1, b, 1) + slope_part(at2, b, 2) + slope_part(at3, b, 3) +
                     slope_part(at4, b, 4) + slope_part(at5, b, 5) + slope_part(at6, b, 6) + slope_part(at7, b, 7);
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
