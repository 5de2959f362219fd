// Sky, half-spaces and rigid bodies, one ray per pixel; four where a body's outline may pass through the pixel.
#include "render/camera.glsl"
#include "render/shadow.glsl"
#include "render/light.glsl"
#include "render/sunlight.glsl"
#if HAS_BODY_KIND
#include "render/shapes.glsl"
#include "render/occlusion.glsl"
#include "render/surfaces.glsl"
#endif

void main() {
  vec3 ray = camera_ray(gl_FragCoord.xy);
  vec3 color = sky(ray);
  gl_FragDepth = no_depth;
#if HAS_BODY_KIND
  bool outline, ignored;
  choose_bodies(gl_FragCoord.xy);
  Hit hit = first_hit(camera_from, ray, outline);
  if (hit.body >= 0) gl_FragDepth = depth_at(hit.distance * dot(ray, camera_axes()[2]));
  color = seen(ray, hit);
  if (outline) {
    const vec2 offsets[3] = vec2[](vec2(0.25, -0.375), vec2(-0.375, -0.125), vec2(0.125, 0.375));
    for (int i = 0; i < 3; ++i) {
      vec3 beside = camera_ray(gl_FragCoord.xy + offsets[i]);
      color += seen(beside, first_hit(camera_from, beside, ignored));
    }
    color *= 0.25;
  }
#endif
  image = pixel_color(color, gl_FragCoord.xy);
}
