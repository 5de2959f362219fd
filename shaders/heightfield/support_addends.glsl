// What a cell in contact adds to its body's sums: the force it bears, and that times where it is, from the field's lowest corner.
#include "heightfield/support_sums.glsl"
#include "lib/own_cell.glsl"
#include "lib/body_sums.glsl"

bool addends(out int body, out vec4 values) {
  ivec2 cell;
  if (!own_cell(cell)) return false;
  int i = cell_index(cell);
  body = owner[i];
  if (body < 0 || body >= int(bodies_count) || underside[i] > ground[i] + depth[i] + skin) return false;
  bool on_ground = underside[i] <= ground[i] + skin;
  float bears = on_ground ? ground_strength : strength * pow(clamp(density[i] / max_density, 0.0, 1.0), exponent);
  if (!(bears > 0.0)) return false;
  vec2 place = field_cell * (vec2(cell) + 0.5);
  values = bears * field_cell * field_cell * vec4(1.0, place.x, underside[i], place.y);
  return true;
}
