// Per cell: the slopes of the surface, the share of the sky that is seen over the snow around and over bodies, and the share of the
// sun that comes over the snow.
#include "render/field_heights.glsl"
#if HAS_BODY_KIND
#include "render/shapes.glsl"
#include "render/occlusion.glsl"
#endif

float height_at(ivec2 cell) {
  cell = clamp(cell, ivec2(0), ivec2(cells_width, cells_height) - 1);
  return field_height_at(cell.y * cells_width + cell.x);
}

// Differences of the heights on both sides, one-sided at the field's edges [H 4.9].
vec2 slopes(ivec2 cell) {
  ivec2 last = ivec2(cells_width, cells_height) - 1;
  ivec2 low = max(cell - 1, ivec2(0)), high = min(cell + 1, last);
  vec2 rise = vec2(height_at(ivec2(high.x, cell.y)) - height_at(ivec2(low.x, cell.y)),
                   height_at(ivec2(cell.x, high.y)) - height_at(ivec2(cell.x, low.y)));
  return rise / (field_cell * vec2(max(high - low, ivec2(1))));
}

// Mean over eight directions of the sky above the horizon that the snow itself makes: cos^2 of its elevation.
float open_sky(ivec2 cell, float height) {
  const ivec2 ways[8] = ivec2[8](ivec2(1, 0), ivec2(1, 1), ivec2(0, 1), ivec2(-1, 1), ivec2(-1, 0), ivec2(-1, -1), ivec2(0, -1), ivec2(1, -1));
  const int steps[5] = int[5](1, 2, 4, 7, 12);
  float open = 0.0;
  for (int w = 0; w < 8; ++w) {
    float run = field_cell * length(vec2(ways[w])), horizon = 0.0;
    for (int s = 0; s < 5; ++s)
      horizon = max(horizon, (height_at(cell + steps[s] * ways[w]) - height) / (float(steps[s]) * run));
    open += 1.0 / (1.0 + horizon * horizon);
  }
  return open / 8.0;
}

// The sun's lower edge and its glow soften a shadow over this difference of tangents.
const float penumbra = 0.10;
const float highest_pile = 0.8;  // m above what the scene began with; higher ones cast somewhat shorter shadows

float sun_over_snow(vec2 place, float height) {
  float across = length(sun_direction.xz);
  if (sun_direction.y >= 0.0) return 0.0;
  if (across < 1.0e-4) return 1.0;
  vec2 way = -sun_direction.xz / across;
  float rise = -sun_direction.y / across, horizon = -1.0;
  float reach = (scene_max.y + highest_pile - height) / rise;
  float run = field_cell;
  for (int i = 0; i < 48 && run < reach; ++i) {
    horizon = max(horizon, (field_height_near(place + run * way) - height) / run);
    run += field_cell * (i < 20 ? 1.0 : 3.0);
  }
  return 1.0 - smoothstep(rise - penumbra, rise + penumbra, horizon);
}

void main() {
  uint i = element_index();
  if (i >= cells_count) return;
  ivec2 cell = ivec2(int(i) % cells_width, int(i) / cells_width);
  float height = field_height_at(int(i));
  vec2 slope = slopes(cell);
  vec2 place = field_min.xz + field_cell * (vec2(cell) + 0.5);
  float open = open_sky(cell, height);
#if HAS_BODY_KIND
  open *= sky_left_by_bodies(vec3(place.x, height, place.y), normalize(vec3(-slope.x, 1.0, -slope.y)), -1);
#endif
  field_slope[i] = slope;
  field_light[i] = vec2(open, sun_over_snow(place, height));
}
