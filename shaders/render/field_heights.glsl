// The surface of the height field between cell centres: bilinear, constant beyond the outermost centres.
// Needs the sampled port field_height and the constants field_min, field_cell.

struct Cells {
  ivec4 index;   // low x and z, high x, high z, high both
  vec4 weights;
};

Cells cells_near(vec2 place) {
  vec2 at = (place - field_min.xz) / field_cell - 0.5;
  vec2 last = vec2(cells_width, cells_height) - 1.0;
  at = clamp(at, vec2(0.0), last);
  ivec2 low = ivec2(at), high = min(low + 1, ivec2(last));
  vec2 f = at - vec2(low);
  Cells cells;
  cells.index = ivec4(low.y, low.y, high.y, high.y) * cells_width + ivec4(low.x, high.x, low.x, high.x);
  cells.weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
  return cells;
}

float field_height_near(vec2 place) {
  Cells c = cells_near(place);
  return dot(c.weights, vec4(field_height_at(c.index.x), field_height_at(c.index.y), field_height_at(c.index.z),
                             field_height_at(c.index.w)));
}
