// What a ray from the camera sees of the rigid bodies. Needs camera, shadow, light, sunlight, shapes and occlusion, and the sampled
// ports body_color, body_bound (body_bounds.comp) and tile_bodies (body_tiles.comp). A shader calls choose_bodies() first.
#include "render/tiles.glsl"

// Those that may be seen in a pixel: all, where the tile has no list or it is too short.
int chosen_start, chosen_count;
bool chosen_all;

void choose_bodies(vec2 pixel) {
  ivec2 at = ivec2(pixel) / tile_pixels;
  int tile = at.y * tiles_across() + at.x;
  chosen_start = tile * tile_list + 1;
  chosen_count = tile < tiles_with_lists() ? int(tile_bodies_at(chosen_start - 1)) : tile_list;
  chosen_all = chosen_count >= tile_list;
  if (chosen_all) chosen_count = int(bodies_count);
}
int chosen_body(int k) { return chosen_all ? k : int(tile_bodies_at(chosen_start + k)); }

const float ground_slope = 0.2;  // half-spaces whose normal is steeper than this are walls
const float glass_tint = 0.07;

bool is_ground(vec3 normal) { return normal.y > ground_slope; }

// Distance along the ray into the half-space of points x with dot(plane.xyz, x) < plane.w; far_away where it misses or the camera stands
// inside.
float half_space_distance(vec3 from, vec3 ray, vec4 plane) {
  float height = dot(from, plane.xyz) - plane.w, sinking = -dot(ray, plane.xyz);
  return height <= 0.0 || sinking <= 1.0e-6 ? far_away : height / sinking;
}

// `outline`: whether that of a body that is not a half-space may run through the ray's pixel.
Hit first_hit(vec3 from, vec3 ray, out bool outline) {
  Hit hit = Hit(far_away, -1, vec3(0.0));
  outline = false;
  for (int k = 0; k < chosen_count; ++k) {
    int b = chosen_body(k);
    int kind = body_kind_at(b);
    vec4 bound = body_bound_at(b);
    if (kind == 0) {
#if !WALLS_SOLID
      if (!is_ground(bound.xyz)) continue;
#endif
      float t = half_space_distance(from, ray, bound);
      if (t < hit.distance) hit = Hit(t, b, bound.xyz);
    } else {
      vec3 to_center = bound.xyz - from;
      float along = dot(to_center, ray), pixel = pixel_angle() * along;
      float beside = length(to_center - along * ray);
      if (along <= 0.0 || beside > bound.w + pixel) continue;
      outline = outline || kind != 1 || beside > bound.w - 2.0 * pixel;
      hit_solid(b, kind, from, ray, hit);
    }
  }
  return hit;
}

// Distance to the nearest of lines one unit apart -> how strongly it shows, over a pixel of this width.
float line(float place, float half_width, float pixel) {
  float away = abs(fract(place - 0.5) - 0.5);
  float width = max(half_width, 0.5 * pixel);
  return (1.0 - smoothstep(width, width + pixel, away)) * min(1.0, half_width / (0.5 * pixel)) * (1.0 - smoothstep(0.2, 0.5, pixel));
}

// Metres with fine lines, every fifth a little stronger.
float ruler_lines(vec2 place, float pixel) {
  float metres = max(line(place.x, 0.006, pixel), line(place.y, 0.006, pixel));
  float fifths = max(line(place.x / 5.0, 0.0024, pixel / 5.0), line(place.y / 5.0, 0.0024, pixel / 5.0));
  return max(0.6 * metres, fifths);
}

// A mark on round bodies that shows how they turn.
float stripe(int kind, vec3 local, float radius) {
  if (kind == 2 || kind == 4) return 0.0;
  float across = min(abs(local.x), abs(local.z)) / radius;
  return 0.22 * (1.0 - smoothstep(0.10, 0.13, across));
}

float scene_size() { return length(scene_max - scene_min); }

vec3 surface_color(vec3 x, vec3 ray, Hit hit) {
  int kind = body_kind_at(hit.body);
  vec4 turn = body_orientation_at(hit.body);
  vec3 local = turned_back(turn, x - body_position_at(hit.body));
  vec3 albedo = linear(body_color_at(hit.body));
  if (kind == 0) {
    float pixel = pixel_angle() * hit.distance / max(abs(dot(ray, hit.normal)), 0.02);
    albedo *= 1.0 - 0.5 * ruler * ruler_lines(local.xz, pixel);
  } else {
    albedo *= 1.0 - stripe(kind, local, body_size_at(hit.body).x);
  }
  float facing = max(dot(hit.normal, -sun_direction), 0.0);
  float texel = shadow_texel();  // off the surface by what the filter reaches, or it would shade itself
  float sun = facing > 0.0 ? facing * sunlit(x + 3.0 * texel * hit.normal, texel, 0.0) : 0.0;
  // Many bodies are small ones: their shade on each other is not worth its time.
  float open = bodies_count > 64u ? 1.0 : sky_left_by_bodies(x, hit.normal, hit.body);
  if (kind != 0) open *= 0.75 + 0.25 * smoothstep(-1.0, 0.4, hit.normal.y);  // the ground is near and darker than the sky
  return albedo * (sun * sun_color + open * sky_light(hit.normal));
}

#if WALLS_GLASS
// Where walls meet, they end.
bool behind_another(int wall, vec3 x) {
  for (int k = 0; k < chosen_count; ++k) {
    int b = chosen_body(k);
    if (b != wall && body_kind_at(b) == 0 && dot(body_bound_at(b), vec4(x, -1.0)) < 0.0) return true;
  }
  return false;
}

// Walls and ceilings as panes with a faint metre grid, as far as the scene's box reaches.
vec3 through_panes(vec3 color, vec3 ray, float nearest) {
  for (int k = 0; k < chosen_count; ++k) {
    int b = chosen_body(k);
    if (body_kind_at(b) != 0) continue;
    vec4 plane = body_bound_at(b);
    if (is_ground(plane.xyz)) continue;
    float t = half_space_distance(camera_from, ray, plane);
    if (t >= nearest) continue;
    vec3 x = camera_from + t * ray;
    if (any(lessThan(x, scene_min - 1.0e-3)) || any(greaterThan(x, scene_max + 1.0e-3)) || behind_another(b, x)) continue;
    vec3 local = turned_back(body_orientation_at(b), x - body_position_at(b));
    float pixel = pixel_angle() * t / max(abs(dot(ray, plane.xyz)), 0.02);
    color = mix(color, vec3(0.9, 0.95, 1.0), glass_tint + 0.35 * ruler * ruler_lines(local.xz, pixel));
  }
  return color;
}
#endif

vec3 seen(vec3 ray, Hit hit) {
  vec3 color = sky(ray);
  if (hit.body >= 0) {
    vec3 surface = surface_color(camera_from + hit.distance * ray, ray, hit);
    // Beyond the horizon the ground is the haze that the sky begins with.
    vec3 far_color = sky(normalize(vec3(ray.x, 0.0, ray.z)));
    color = mix(surface, far_color, haze(hit.distance, 6.0 * scene_size()));
  }
#if WALLS_GLASS
  color = through_panes(color, ray, hit.distance);
#endif
  return color;
}
