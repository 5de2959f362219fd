// How finely every patch is cut. Patches beyond the last, behind the camera or beside the picture are left out.
#include "render/camera.glsl"
#include "render/field_heights.glsl"
#include "render/field_patches.glsl"

layout(vertices = 1) out;

flat in int patch_number[];
patch out int number;

// Is the box round these points outside of one side of the picture?
bool unseen(vec3 low, vec3 high) {
  ivec2 left_right = ivec2(0), below_above = ivec2(0);
  int behind = 0;
  for (int i = 0; i < 8; ++i) {
    vec4 clip = clip_position(vec3((i & 1) == 0 ? low.x : high.x, (i & 2) == 0 ? low.y : high.y, (i & 4) == 0 ? low.z : high.z));
    left_right += ivec2(clip.x < -clip.w, clip.x > clip.w);
    below_above += ivec2(clip.y < -clip.w, clip.y > clip.w);
    behind += int(clip.w <= 0.0);
  }
  return any(equal(left_right, ivec2(8))) || any(equal(below_above, ivec2(8))) || behind == 8;
}

void main() {
  ivec2 at = patch_at(patch_number[0]);
  number = patch_number[0];
  vec3 p00 = patch_point(vec2(at)), p10 = patch_point(vec2(at + ivec2(1, 0)));
  vec3 p01 = patch_point(vec2(at + ivec2(0, 1))), p11 = patch_point(vec2(at + ivec2(1, 1)));
  vec3 low = min(min(p00, p10), min(p01, p11)), high = max(max(p00, p10), max(p01, p11));
  const float room = 3.0;  // m that snow may stand higher or lower than at the patch's corners
  low.y -= room;
  high.y += room;
  bool left_out = number >= patch_side() * patch_side() || unseen(low, high);
#if !SURROUNDINGS_SNOW
  left_out = left_out || (at.x != clamp(at.x, 0, patches - 1) && at.y != clamp(at.y, 0, patches - 1));  // corners without area
#endif
  vec4 edges = patch_edges(p00, p10, p01, p11);
  if (left_out) edges = vec4(0.0);
  gl_TessLevelOuter[0] = edges.x;
  gl_TessLevelOuter[1] = edges.y;
  gl_TessLevelOuter[2] = edges.z;
  gl_TessLevelOuter[3] = edges.w;
  gl_TessLevelInner[0] = 0.5 * (edges.y + edges.w);
  gl_TessLevelInner[1] = 0.5 * (edges.x + edges.z);
}
