// Sun and sky of a clear winter day, and the way from light to pixels. Colours are linear; 1 is what white snow in full light sends out.
// Needs the constant sun_direction and the parameter exposure.

const vec3 sun_color = vec3(0.90, 0.81, 0.68);
const vec3 horizon_color = vec3(0.60, 0.69, 0.77);
const vec3 zenith_color = vec3(0.10, 0.23, 0.48);

vec3 sky(vec3 ray) {
  float height = clamp(ray.y, 0.0, 1.0);
  vec3 color = mix(zenith_color, horizon_color, exp(-5.0 * height));
  float glow = max(dot(ray, -sun_direction), 0.0);
  glow *= glow * glow;
  glow *= glow;
  float bright = glow * glow;
  bright *= bright * bright;
  return color + sun_color * (0.10 * glow + 0.25 * bright);
}

// What the whole sky sends to a surface, and the ground below what faces it.
vec3 sky_light(vec3 normal) { return mix(vec3(0.12, 0.125, 0.14), vec3(0.17, 0.235, 0.34), 0.5 + 0.5 * normal.y); }

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

// Colours of files are sRGB, as people pick them. A polynomial and roots in place of the standard's powers, which would cost more than all
// the rest of a pixel: within half a step of 8 bits, and within one above 0.005, three in near black.
vec3 linear(vec3 color) { return color * (color * (color * 0.305306011 + 0.682171111) + 0.012522878); }

vec3 srgb(vec3 color) {
  vec3 a = sqrt(max(color, 0.0)), b = sqrt(a), c = sqrt(b);
  return max(0.585122381 * a + 0.783140355 * b - 0.368262736 * c, 0.0);
}

// Four-by-four ordered pattern of half a step of 8 bits either way: gradients without bands, the same in every frame.
float dither(vec2 pixel) {
  ivec2 p = ivec2(pixel) & 3;
  int rank = ((p.x ^ p.y) & 1) * 8 + (p.y & 1) * 4 + ((p.x ^ p.y) >> 1 & 1) * 2 + (p.y >> 1 & 1);
  return (float(rank) - 7.5) / (16.0 * 255.0);
}

vec4 pixel_color(vec3 light, vec2 pixel) { return vec4(srgb(held_back(exposure * light)) + dither(pixel), 1.0); }
