// Snow in sun and sky light; what is pressed is bluer, darker and does not glitter; where there is none, earth.
#include "render/camera.glsl"
#include "render/light.glsl"
#include "render/shadow.glsl"
#include "render/sunlight.glsl"
#include "render/random.glsl"
#include "render/field_heights.glsl"
#include "render/grain.glsl"

in vec3 place;
flat in vec3 side;

const vec3 earth_color = vec3(0.115, 0.080, 0.052);  // linear

const float thin = 0.012;  // m: a cover through which the ground shows

struct Cover {
  vec2 slope;
  float sky, sun;  // shares that arrive
  float depth;     // of snow, m
  float pressed;   // 0 at the least density, 1 at the largest
};

Cover cover_near(vec2 at) {
  Cells c = cells_near(at);
  vec2 slope = vec2(0.0), light = vec2(0.0), look = vec2(0.0);
  for (int i = 0; i < 4; ++i) {
    slope += c.weights[i] * field_slope_at(c.index[i]);
    light += c.weights[i] * field_light_at(c.index[i]);
    look += c.weights[i] * field_look_at(c.index[i]);
  }
  return Cover(slope, light.x, light.y, look.x, look.y);
}

// 1 for snow, 0 for what has a colour of its own, as sand.
float snowiness(vec3 color) {
  float most = max(color.r, max(color.g, color.b)), least = min(color.r, min(color.g, color.b));
  return 1.0 - smoothstep(0.12, 0.3, most - least);
}

void main() {
  vec3 to_camera = camera_from - place;
  float distance = length(to_camera);
  vec3 view = to_camera / distance;
  Cover cover = cover_near(place.xz);
  float covered = smoothstep(0.0, thin, cover.depth);
  bool on_side = any(notEqual(side, vec3(0.0)));
  // Within snow and earth, colours follow the height.
  vec2 texture_place = on_side ? vec2(place.x + place.z, place.y) : place.xz;
  float pixel = pixel_angle() * distance;
  if (on_side) {
    float below = field_height_near(place.xz) - place.y;
    covered *= smoothstep(-0.5 * thin, 0.5 * thin, cover.depth - below);
  }

  float is_snow = snowiness(field_color);
  float loose = 1.0 - smoothstep(0.55, 0.95, cover.pressed);
  // Soft undulation of a few centimetres and the grain itself; pressed snow is smooth.
  vec3 coarse = noise(texture_place * 9.0), middle = noise(texture_place * 31.0), fine = noise(texture_place * 90.0);
  vec3 weights = vec3(visible(0.11, pixel), visible(0.032, pixel), visible(0.011, pixel)) *
                 mix(vec3(0.10, 0.25, 0.35), vec3(0.16, 0.40, 0.50), mix(1.0, loose, covered)) *
                 mix(vec3(0.7), vec3(0.35, 0.4, 0.5), is_snow * covered);
  vec2 rough = weights.x * 0.35 * coarse.yz + weights.y * 0.22 * middle.yz + weights.z * 0.22 * fine.yz;
  vec3 normal = on_side ? normalize(side + vec3(0.4 * rough.x, 0.4 * rough.y, 0.4 * rough.x) * (1.0 - abs(side)))
                        : normalize(vec3(-cover.slope - rough, 1.0).xzy);

  vec3 fresh = linear(field_color);
  vec3 pressed = fresh * mix(vec3(0.62), vec3(0.52, 0.66, 0.80), is_snow);
  vec3 snow = mix(pressed, fresh, loose) * (1.0 + mix(0.04, 0.02, is_snow) * (coarse.x + middle.x + fine.x * weights.z));
  vec3 earth = earth_color * (1.0 + 0.35 * coarse.x + 0.3 * middle.x);
  vec3 albedo = mix(earth, snow, covered);

  // Light goes some way through snow: it wraps round edges.
  float wrap = 0.18 * is_snow * covered;
  float facing = max((dot(normal, -sun_direction) + wrap) / (1.0 + wrap), 0.0);
  float sun = facing > 0.0 ? facing * cover.sun * sunlit(place + 1.5 * shadow_texel() * normal, 0.0, 0.0) : 0.0;
  // In hollows snow lights itself: what is lost of the sky comes back in part, white.
  float open = mix(cover.sky, 1.0, 0.25 * covered * is_snow);
  vec3 color = albedo * (sun * sun_color + open * sky_light(normal));
  vec3 halfway = normalize(view - sun_direction);
  float glitter = is_snow * covered * loose * glints(texture_place, normal, halfway, pixel);
  color += 0.8 * glitter * min(sun, cover.sun) * sun_color;

  vec3 far_color = sky(normalize(vec3(-view.x, 0.0, -view.z)));
  image = pixel_color(mix(color, far_color, haze(distance, 6.0 * length(scene_max - scene_min))), gl_FragCoord.xy);
}
