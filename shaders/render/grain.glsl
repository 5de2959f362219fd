// Roughness of snow too fine for the field: noise with slopes, and single glints. Needs random.glsl.

uint mixed(uvec2 p) {
  uint h = p.x * 0x9e3779b1u ^ p.y * 0x85ebca77u;
  h ^= h >> 15u;
  h *= 0x2c1b3c6du;
  h ^= h >> 12u;
  h *= 0x297a2d39u;
  return h ^ (h >> 15u);
}
float lattice(ivec2 p) { return float(mixed(uvec2(p)) >> 8u) / 8388608.0 - 1.0; }

// Value between -1 and 1 in x, its derivatives in yz: smooth between random values at whole numbers.
vec3 noise(vec2 p) {
  vec2 low = floor(p), f = p - low;
  vec2 u = f * f * (3.0 - 2.0 * f), du = 6.0 * f * (1.0 - f);
  ivec2 i = ivec2(low);
  float a = lattice(i), b = lattice(i + ivec2(1, 0)), c = lattice(i + ivec2(0, 1)), d = lattice(i + ivec2(1, 1));
  float k = a - b - c + d;
  return vec3(a + (b - a) * u.x + (c - a) * u.y + k * u.x * u.y, du * (vec2(b - a, c - a) + k * u.yx));
}

// How well structure of this size is seen in pixels of that width.
float visible(float size, float pixel) { return clamp(0.5 * size / pixel - 0.5, 0.0, 1.0); }

// Crystals that mirror the sun into the camera: on a lattice of about a pixel, each with its own facing.
float glints(vec2 p, vec3 normal, vec3 halfway, float pixel) {
  float size = 0.008 * exp2(ceil(log2(max(pixel / 0.008, 1.0))));
  vec4 random = random_numbers(uvec2(ivec2(floor(p / size))));
  vec3 facing = normalize(normal + 1.1 * (2.0 * random.xyz - 1.0));
  return smoothstep(0.985, 0.998, dot(facing, halfway)) * float(random.w > 0.35);
}
