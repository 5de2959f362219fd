// What a cell in contact adds to its body's sums: the force it bears, and that times where it is, from the field's lowest corner.
#include "heightfield/support_sums.glsl"
#include "lib/own_column.glsl"

uint lowest_body(int i) { return uint(owner[i]); }

void cell_addends(ivec2 cell, int i, out ivec4 bodies, out vec4 values) {
  bool on_ground = underside[i] <= ground[i] + skin;
  float bears = on_ground ? ground_strength : strength * pow(clamp(density[i] / max_density, 0.0, 1.0), exponent);
  bodies = ivec4(underside[i] <= ground[i] + depth[i] + skin && bears > 0.0 ? owner[i] : -1);
  vec2 place = field_cell * (vec2(cell) + 0.5);
  values = bears * field_cell * field_cell * vec4(1.0, place.x, underside[i], place.y);
}

#include "lib/column_sums.glsl"
