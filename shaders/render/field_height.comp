// Height of the snow's surface H = B + S [H 3.1], and what its look depends on: depth and how pressed it is.

void main() {
  uint i = element_index();
  if (i >= cells_count) return;
  float snow = depth_at(int(i));
  field_height[i] = ground_at(int(i)) + snow;
  float pressed = 0.0;
#if HAS_DENSITY
  pressed = clamp((density_at(int(i)) - min_density) / (max_density - min_density), 0.0, 1.0);
#endif
  field_look[i] = vec2(snow, pressed);
}
