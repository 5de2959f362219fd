#include "render/camera.glsl"
#include "render/field_heights.glsl"
#include "render/field_patches.glsl"

layout(quads, fractional_even_spacing, ccw) in;

patch in int number;
out vec3 place;
flat out vec3 side;  // outward normal of the block's sides; 0 on the snow

void main() {
  ivec2 at = patch_at(number);
  place = patch_point(vec2(at) + gl_TessCoord.xy);
  side = vec3(0.0);
#if !SURROUNDINGS_SNOW
  ivec2 outward = at - clamp(at, ivec2(0), ivec2(patches - 1));
  side = vec3(outward.x, 0.0, outward.y);
#endif
  gl_Position = clip_position(place);
}
