// A grain of snow: a ball's outline and depth; its light is that of the snow it lies in, roughened by its own shape.
#include "render/camera.glsl"
#include "render/light.glsl"
#include "render/sphere.glsl"

in vec3 place;
flat in vec3 center;
flat in float size;
flat in vec4 surface;
flat in vec4 color;

void main() {
  vec3 ray = normalize(place - camera_from);
  float t = sphere_distance(camera_from, ray, center, size);
  if (t <= 0.0) discard;
  vec3 x = camera_from + t * ray;
#if DETAIL_SPHERES
  gl_FragDepth = depth_at(t * dot(ray, camera_axes()[2]));
#endif
  vec3 own = (x - center) / size;
  vec3 normal = normalize(surface.xyz + 0.7 * own);
  // Light goes some way through snow: it wraps round edges, and into shade.
  const float wrap = 0.2;
  float facing = max((dot(normal, -sun_direction) + wrap) / (1.0 + wrap), 0.0);
  vec3 light = color.rgb * (facing * surface.w * sun_color + color.w * sky_light(normal));
  image = pixel_color(light, gl_FragCoord.xy);
}
