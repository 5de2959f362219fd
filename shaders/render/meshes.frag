#include "render/camera.glsl"
#include "render/shadow.glsl"
#include "render/light.glsl"
#include "render/sunlight.glsl"
#if HAS_BODY_KIND
#include "render/shapes.glsl"
#include "render/occlusion.glsl"
#include "render/surfaces.glsl"
#endif

in vec3 place;
flat in vec3 normal;
flat in int body;

void main() {
  vec3 color = vec3(0.0);
#if HAS_BODY_KIND && HAS_FACET_POINTS
  choose_bodies(gl_FragCoord.xy);
  vec3 ray = place - camera_from;
  float distance = length(ray);
  ray /= distance;
  // Meshes that are not closed are seen from inside too.
  color = seen(ray, Hit(distance, body, dot(ray, normal) > 0.0 ? -normal : normal));
#endif
  image = pixel_color(color, gl_FragCoord.xy);
}
