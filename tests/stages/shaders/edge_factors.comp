// The four edges of every patch, as shaders/render/heightfield.tesc cuts them.
#include "render/field_heights.glsl"
#include "render/field_patches.glsl"

void main() {
  uint i = element_index();
  if (i >= patch_numbers_count) return;
  ivec2 at = patch_at(int(i));
  vec3 p00 = patch_point(vec2(at)), p10 = patch_point(vec2(at + ivec2(1, 0)));
  vec3 p01 = patch_point(vec2(at + ivec2(0, 1))), p11 = patch_point(vec2(at + ivec2(1, 1)));
  edge_factors[i] = patch_edges(p00, p10, p01, p11);
  corner[i] = p00;
}
