// Seen from below: one pixel per cell, right is +x, up is +z. The fragment sets the depth.
vec4 on_field(vec2 place) { return vec4(2.0 * (place - field_min.xz) / (field_cell * vec2(cells_width, cells_height)) - 1.0, 0.0, 1.0); }
