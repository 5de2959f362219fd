// The middle of this fragment's cell.
vec2 cell_center() { return field_min.xz + field_cell * gl_FragCoord.xy; }

// Lower hides higher; any height fits between 0 and 1.
void show(float height, int body) {
  underside_map = vec4(height, float(body), 0.0, 0.0);
  gl_FragDepth = 0.5 + 0.5 * height / (1.0 + abs(height));
}
