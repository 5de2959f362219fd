// Interpolation by tensor products of B-splines [M 17-20]: KERNEL_CUBIC (4 nodes per axis) or KERNEL_QUADRATIC (3).

#if KERNEL_CUBIC
const int stencil_width = 4;
#else
const int stencil_width = 3;
#endif

// Lowest node that a particle in grid coordinates x reaches.
ivec3 stencil_base(vec3 x) {
#if KERNEL_CUBIC
  return ivec3(floor(x)) - 1;
#else
  return ivec3(floor(x - 0.5));
#endif
}

// N(u) and N'(u), u = (x_p - x_i) / h.
float spline(float u) {
  float a = abs(u);
#if KERNEL_CUBIC
  float far = 2.0 - a;
  return a < 1.0 ? (0.5 * a - 1.0) * a * a + 2.0 / 3.0 : a < 2.0 ? far * far * far / 6.0 : 0.0;
#else
  float far = 1.5 - a;
  return a < 0.5 ? 0.75 - a * a : a < 1.5 ? 0.5 * far * far : 0.0;
#endif
}
float spline_slope(float u) {
  float a = abs(u);
#if KERNEL_CUBIC
  float far = 2.0 - a;
  return a < 1.0 ? (1.5 * a - 2.0) * u : a < 2.0 ? -0.5 * far * far * sign(u) : 0.0;
#else
  return a < 0.5 ? -2.0 * u : a < 1.5 ? u - 1.5 * sign(u) : 0.0;
#endif
}

// The same for four u at once, without branches.
vec4 spline(vec4 u) {
#if KERNEL_CUBIC
  vec4 far = max(2.0 - abs(u), 0.0), near = max(1.0 - abs(u), 0.0);
  return (far * far * far - 4.0 * near * near * near) / 6.0;
#else
  vec4 far = max(1.5 - abs(u), 0.0), near = max(0.5 - abs(u), 0.0);
  return 0.5 * far * far - 1.5 * near * near;
#endif
}
vec4 spline_slope(vec4 u) {
#if KERNEL_CUBIC
  vec4 far = max(2.0 - abs(u), 0.0), near = max(1.0 - abs(u), 0.0);
  vec4 size = 0.5 * far * far - 2.0 * near * near;
#else
  vec4 size = max(1.5 - abs(u), 0.0) - 3.0 * max(0.5 - abs(u), 0.0);
#endif
  return uintBitsToFloat(floatBitsToUint(size) ^ ~floatBitsToUint(u) & 0x80000000u);  // falls where u is positive
}

// N and N' where x_p = x_i + (offset + f) h, offset -2, -1, 0 or 1 and f within [0, 1]: what many particles of one cell have in common is
// worked out first. Cubic: the coefficients of 1, f, f^2, f^3.
vec4 spline_piece(int offset) {
#if KERNEL_CUBIC
  return offset == -2   ? vec4(0.0, 0.0, 0.0, 1.0) / 6.0
         : offset == -1 ? vec4(1.0, 3.0, 3.0, -3.0) / 6.0
         : offset == 0  ? vec4(4.0, 0.0, -6.0, 3.0) / 6.0
         : offset == 1  ? vec4(1.0, -3.0, 3.0, -1.0) / 6.0
                        : vec4(0.0);
#else
  return vec4(offset);
#endif
}
vec2 spline_and_slope(vec4 piece, float f) {
#if KERNEL_CUBIC
  // The piece that ends at f = 1 is taken from there, g^3 / 6: as a polynomial in f it would be nothing but rounding there, of either sign,
  // and nodes that hardly any mass reaches would divide by that.
  bool from_end = piece.y < 0.0;
  float t = from_end ? 1.0 - f : f;
  vec4 c = from_end ? vec4(0.0, 0.0, 0.0, 1.0) / 6.0 : piece;
  float slope = (3.0 * c.w * t + 2.0 * c.z) * t + c.y;
  return vec2(((c.w * t + c.z) * t + c.y) * t + c.x, from_end ? -slope : slope);
#else
  return vec2(spline(piece.x + f), spline_slope(piece.x + f));
#endif
}

// The same for all nodes of one axis at once; u of the lowest node, in [1, 2] (quadratic: [0.5, 1.5]) as stencil_base gives it. Component 3 is 0
// for the quadratic kernel.
vec4 spline4(float u) {
#if KERNEL_CUBIC
  float f = u - 1.0, g = 2.0 - u;
  return vec4(g * g * g / 6.0, (0.5 * f - 1.0) * f * f + 2.0 / 3.0, (0.5 * g - 1.0) * g * g + 2.0 / 3.0, f * f * f / 6.0);
#else
  float f = u - 0.5, g = 1.5 - u, c = u - 1.0;
  return vec4(0.5 * g * g, 0.75 - c * c, 0.5 * f * f, 0.0);
#endif
}
vec4 spline_slope4(float u) {
#if KERNEL_CUBIC
  float f = u - 1.0, g = 2.0 - u;
  return vec4(-0.5 * g * g, (1.5 * f - 2.0) * f, (2.0 - 1.5 * g) * g, 0.5 * f * f);
#else
  return vec4(u - 1.5, 2.0 - 2.0 * u, u - 0.5, 0.0);
#endif
}

// The same from the node below the particle's cell on, u in [1, 2]: all that any particle of the cell reaches.
#if KERNEL_CUBIC
vec4 spline_of_cell(float u) { return spline4(u); }
vec4 slope_of_cell(float u) { return spline_slope4(u); }
#else
vec4 spline_of_cell(float u) { return spline(u - vec4(0.0, 1.0, 2.0, 3.0)); }
vec4 slope_of_cell(float u) { return spline_slope(u - vec4(0.0, 1.0, 2.0, 3.0)); }
#endif
