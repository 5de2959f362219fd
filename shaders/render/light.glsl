// Sun and sky of a clear winter day, and the way from light to pixels. Colours are linear; 1 is what white snow in full light sends out.
// Needs the constant sun_direction and the parameter exposure.

const vec3 sun_color = vec3(0.92, 0.85, 0.75);
const vec3 horizon_color = vec3(0.58, 0.68, 0.78);
const vec3 zenith_color = vec3(0.13, 0.27, 0.50);

vec3 sky(vec3 ray) {
  float height = clamp(ray.y, 0.0, 1.0);
  vec3 color = mix(zenith_color, horizon_color, exp(-5.0 * height));
  float toward_sun = max(dot(ray, -sun_direction), 0.0);
  return color + sun_color * (0.10 * pow(toward_sun, 6.0) + 0.25 * pow(toward_sun, 64.0));
}

// What the whole sky sends to a surface, and the ground below what faces it.
vec3 sky_light(vec3 normal) { return mix(vec3(0.11, 0.125, 0.15), vec3(0.18, 0.25, 0.37), 0.5 + 0.5 * normal.y); }

// Where distance hides things: 0 near, 1 in the haze.
float haze(float distance, float reach) {
  float share = distance / reach;
  return 1.0 - exp(-share * share);
}

// Only what comes near to white is held back, so that snow keeps its shape in full light.
vec3 held_back(vec3 color) {
  const float knee = 0.8;
  vec3 above = max(color - knee, 0.0);
  return min(color, knee) + (1.0 - knee) * (1.0 - exp(-above / (1.0 - knee)));
}

// Colours of files are sRGB, as people pick them.
vec3 linear(vec3 srgb_color) {
  return mix(pow((srgb_color + 0.055) / 1.055, vec3(2.4)), srgb_color / 12.92, lessThan(srgb_color, vec3(0.04045)));
}

vec3 srgb(vec3 color) {
  return mix(1.055 * pow(max(color, 1.0e-4), vec3(1.0 / 2.4)) - 0.055, 12.92 * color, lessThan(color, vec3(0.0031308)));
}

// Four-by-four ordered pattern of half a step of 8 bits either way: gradients without bands, the same in every frame.
float dither(vec2 pixel) {
  ivec2 p = ivec2(pixel) & 3;
  int rank = ((p.x ^ p.y) & 1) * 8 + (p.y & 1) * 4 + ((p.x ^ p.y) >> 1 & 1) * 2 + (p.y >> 1 & 1);
  return (float(rank) - 7.5) / (16.0 * 255.0);
}

vec4 pixel_color(vec3 light, vec2 pixel) { return vec4(srgb(held_back(exposure * light)) + dither(pixel), 1.0); }
