// Meshes as the sun sees them.
#include "render/shadow.glsl"
#if HAS_BODY_KIND && HAS_FACET_POINTS
#include "lib/turn.glsl"
#include "render/facets.glsl"
#endif

void main() {
  gl_Position = vec4(0.0);
#if HAS_BODY_KIND && HAS_FACET_POINTS
  int body = facet_body_at(gl_VertexID / 3);
  gl_Position = nowhere;
  if (body_kind_at(body) != 4) return;
  gl_Position = vec4(2.0 * shadow_coordinates(facet_corner(body, gl_VertexID)) - 1.0, 1.0);
  gl_Position.z = clamp(gl_Position.z, -1.0, 0.99999);  // bodies reach out of the scene's box
#endif
}
