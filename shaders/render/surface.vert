// Triangles of the snow's surface.
#include "render/camera.glsl"

out vec3 place;
out vec3 normal;
out vec3 color;
out vec2 light;  // of the sun, of the sky

void main() {
  ivec3 triangle = surface_triangle_at(gl_VertexID / 3);
  place = normal = color = vec3(0.0);
  light = vec2(0.0);
  gl_Position = vec4(0.0);
  if (triangle.x == triangle.y) return;
  int corner = triangle[gl_VertexID % 3];
  place = surface_corner_at(corner);
  normal = surface_normal_at(corner);
  color = surface_color_at(corner);
  light = surface_light_at(corner);
  gl_Position = clip_position(place);
}
