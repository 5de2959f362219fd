// Numbers that look random and belong to their seed.

// Four in 0..1 (the mixing of PCG4D, Jarzynski and Olano 2020).
vec4 random_numbers(uvec2 seed) {
  uvec4 v = uvec4(seed.x, seed.y, seed.x ^ 0x9e3779b9u, seed.y + 0x85ebca6bu) * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return vec4(v >> 8u) / 16777216.0;
}

// Two numbers in 0..1 -> a unit vector, evenly spread.
vec3 on_sphere(vec2 random) {
  float z = 2.0 * random.x - 1.0, angle = 6.2831853 * random.y;
  return vec3(sqrt(1.0 - z * z) * vec2(cos(angle), sin(angle)), z);
}
