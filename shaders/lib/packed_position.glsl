// Where a particle is in its block, in cells from the block's lowest one: three times 21 bits in two words, in steps of 2^-19 cells. On a
// grid of a hundred nodes a position in single precision has steps of 2^-18.
uvec2 packed_position(vec3 inside) {
  uvec3 steps = uvec3(ivec3(clamp(inside, 0.0, 3.999998) * 524288.0 + 0.5));
  return uvec2(steps.x << 11u | steps.y >> 10u, steps.y << 22u | steps.z);
}
vec3 unpacked_position(uvec2 words) {
  return vec3(ivec3(words.x >> 11u, (words.x & 0x7ffu) << 10u | words.y >> 22u, words.y & 0x1fffffu)) * (1.0 / 524288.0);
}
