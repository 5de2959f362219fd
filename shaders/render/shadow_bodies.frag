#include "render/shadow.glsl"
#if HAS_BODY_KIND
#include "render/shapes.glsl"
#endif

in vec3 start;
flat in int body;

void main() {
#if HAS_BODY_KIND
  Hit hit = Hit(far_away, -1, vec3(0.0));
  hit_solid(body, body_kind_at(body), start, sun_direction, hit);
  if (hit.body < 0) discard;
  gl_FragDepth = clamp(shadow_coordinates(start + hit.distance * sun_direction).z, 0.0, 0.999999);
#else
  discard;
#endif
}
