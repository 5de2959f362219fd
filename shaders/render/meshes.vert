// Mesh bodies as their triangles.
#include "render/camera.glsl"
#if HAS_BODY_KIND && HAS_FACET_POINTS
#include "lib/turn.glsl"
#include "render/facets.glsl"
#endif

out vec3 place;
flat out vec3 normal;
flat out int body;

void main() {
  place = normal = vec3(0.0);
  body = 0;
  gl_Position = vec4(0.0);
#if HAS_BODY_KIND && HAS_FACET_POINTS
  int facet = gl_VertexID / 3;
  body = facet_body_at(facet);
  gl_Position = nowhere;
  if (body_kind_at(body) != 4) return;
  vec3 a = facet_corner(body, 3 * facet), b = facet_corner(body, 3 * facet + 1), c = facet_corner(body, 3 * facet + 2);
  place = gl_VertexID % 3 == 0 ? a : gl_VertexID % 3 == 1 ? b : c;
  normal = normalize(cross(b - a, c - a));
  gl_Position = clip_position(place);
#endif
}
