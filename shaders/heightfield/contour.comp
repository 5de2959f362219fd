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
#define LOOK(n) Overlap at##n = overlap_of(cell + neighbor_offsets[n]);
  FOR_NEIGHBORS(LOOK)
  // By their numbers upwards, so that the first of equals stays. Most cells have no body beside them: then nothing is gone through.
  uint body = uint(-1);
#define FIRST(n) body = min(body, uint(at##n.body));
  FOR_NEIGHBORS(FIRST)
  if (overlap_at(i) > 0.0) body = uint(-1);
  if (body != uint(-1)) do {
    vec2 outward = vec2(0.0);
    uint next = uint(-1);
#define LEAN(n)                                                      \
  outward += slope_part(at##n, int(body), n);                        \
  if (uint(at##n.body) > body) next = min(next, uint(at##n.body));
    FOR_NEIGHBORS(LEAN)
    float size = length(outward);
    float s = direction_factor(body_velocity[body], size > 0.0 ? outward / size : vec2(0.0));
    if (best_owner < 0 || s > best) {
      best = s;
      best_owner = int(body);
    }
    body = next;
  } while (body != uint(-1));
  contour_weight[i] = best;
  contour_owner[i] = best_owner;
}
