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

// The same for all nodes of one axis at once; u of the lowest node. Component 3 is 0 for the quadratic kernel.
vec4 spline4(float u) {
#if KERNEL_CUBIC
  return vec4(spline(u), spline(u - 1.0), spline(u - 2.0), spline(u - 3.0));
#else
  return vec4(spline(u), spline(u - 1.0), spline(u - 2.0), 0.0);
#endif
}
vec4 spline_slope4(float u) {
#if KERNEL_CUBIC
  return vec4(spline_slope(u), spline_slope(u - 1.0), spline_slope(u - 2.0), spline_slope(u - 3.0));
#else
  return vec4(spline_slope(u), spline_slope(u - 1.0), spline_slope(u - 2.0), 0.0);
#endif
}
