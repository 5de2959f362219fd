// A triangle over every body as the sun sees it, in front of it.
#include "render/shadow.glsl"
#include "render/sphere.glsl"
#if HAS_BODY_KIND
#include "render/shapes.glsl"
#endif

out vec3 start;      // where the ray of this fragment begins
flat out int body;

void main() {
  start = vec3(0.0);
  gl_Position = vec4(0.0);
  body = gl_VertexID / 3;
#if HAS_BODY_KIND
  int kind = body_kind_at(body);
  if (kind == 0) return;
  float r = bounding_radius(kind, body_size_at(body).xyz);
  vec2 corner = triangle_corners[gl_VertexID % 3];
  mat3 axes = sun_axes();
  start = body_position_at(body) + r * (axes[0] * corner.x + axes[1] * corner.y - axes[2]);
  gl_Position = vec4(2.0 * shadow_coordinates(start) - 1.0, 1.0);
  gl_Position.z = 0.0;  // bodies reach out of the scene's box; the fragment knows the depth
#endif
}
