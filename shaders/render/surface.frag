// Snow as a surface, lit as its grains would be, and rough as they are.
#include "render/camera.glsl"
#include "render/light.glsl"
#include "render/random.glsl"
#include "render/grain.glsl"

in vec3 place;
in vec3 normal;
in vec3 color;
in vec2 light;

// Slopes of the noise on the three planes of the axes, each as far as the surface looks along its axis.
vec3 roughness(vec3 x, vec3 n) {
  vec3 share = n * n;
  vec2 a = noise(x.yz).yz, b = noise(x.zx + 17.0).yz, c = noise(x.xy + 31.0).yz;
  return share.x * vec3(0.0, a) + share.y * vec3(b.y, 0.0, b.x) + share.z * vec3(c, 0.0);
}

void main() {
  float distance = length(place - camera_from), pixel = pixel_angle() * distance;
  vec3 smooth_normal = normalize(normal);
  // Grains of some millimetres, and lumps of a few centimetres.
  vec3 rough = 0.10 * visible(0.032, pixel) * roughness(31.0 * place, smooth_normal) +
               0.12 * visible(0.011, pixel) * roughness(90.0 * place, smooth_normal);
  vec3 n = normalize(smooth_normal - rough);
  // Light goes some way through snow: it wraps round edges, and into shade.
  const float wrap = 0.2;
  float facing = max((dot(n, -sun_direction) + wrap) / (1.0 + wrap), 0.0);
  vec3 seen = color * (facing * light.x * sun_color + light.y * sky_light(n));
  image = pixel_color(seen, gl_FragCoord.xy);
}
