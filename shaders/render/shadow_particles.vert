// Particles as the sun sees them: discs at the depth of their centres.
#include "render/shadow.glsl"
#include "render/sphere.glsl"

out vec2 from_center;  // in radii

void main() {
  from_center = vec2(0.0);
  gl_Position = vec4(0.0);
#if HAS_POSITION && HAS_VOLUME
  int particle = gl_VertexID / 3;
  from_center = triangle_corners[gl_VertexID % 3];
  float r = radius * pow(volume_at(particle), 1.0 / 3.0);
  mat3 axes = sun_axes();
  vec3 x = position_at(particle) + r * (axes[0] * from_center.x + axes[1] * from_center.y);
  gl_Position = vec4(2.0 * shadow_coordinates(x) - 1.0, 1.0);
#endif
}
