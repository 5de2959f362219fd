// What a cell adds to its body's sums [H 3.6, 3.7]: displaced mass m, and m times where it is, from the field's lowest corner.
#include "heightfield/resistance_sums.glsl"
#include "lib/own_cell.glsl"
#include "lib/body_sums.glsl"

bool addends(out int body, out vec4 values) {
  ivec2 cell;
  if (!own_cell(cell)) return false;
  int i = cell_index(cell);
  body = owner[i];
  if (!(overlap[i] > 0.0) || body < 0 || body >= int(bodies_count)) return false;
  float mass = overlap[i] * density[i] * field_cell * field_cell;
  vec2 place = field_cell * (vec2(cell) + 0.5);
  values = mass * vec4(1.0, place.x, CONTACT_HEIGHT(i), place.y);
  return true;
}
