// How strongly a body that moves with v pushes snow in a direction [H 3.12-3.19], by the parameter `direction`.

// `outward`: unit vector (x, z), or zero where there is no direction.
float direction_factor(vec3 velocity, vec2 outward) {
  // Scaled first, so that neither very slow nor very fast motion is lost when squared.
  float largest = max(abs(velocity.x), max(abs(velocity.y), abs(velocity.z)));
  if (!(largest > 0.0)) return 1.0 / k;
  vec3 v = normalize(velocity / largest);
  float along = max(0.0, dot(v.xz, outward));
  // r = 1 - d as the square of v_y: rounding can then make it neither negative nor, for level motion, other than zero.
  float r = v.y * v.y;
#if DIRECTION_APPENDIX
  return dot(v.xz, v.xz) * along + r / k;
#else
  float level = length(v.xz);
  return (level > 0.0 ? along / level : 0.0) + r / k;
#endif
}
