// What a cell adds to its body's sums [H 3.6, 3.7]: displaced mass m, and m times where it is, from the field's lowest corner.
#include "heightfield/resistance_height.glsl"
#include "heightfield/resistance_sums.glsl"
#include "lib/own_column.glsl"

uint lowest_body(int i) { return uint(owner[i]); }

void cell_addends(ivec2 cell, int i, out ivec4 bodies, out vec4 values) {
  bodies = ivec4(overlap[i] > 0.0 ? owner[i] : -1);
  float mass = overlap[i] * density[i] * field_cell * field_cell;
  vec2 place = field_cell * (vec2(cell) + 0.5);
  values = mass * vec4(1.0, place.x, CONTACT_HEIGHT(i), place.y);
}

#include "lib/column_sums.glsl"
