// Rotations as quaternions (x, y, z, w).

vec4 product(vec4 a, vec4 b) { return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz)); }
vec4 conjugated(vec4 q) { return vec4(-q.xyz, q.w); }

// From and to a vector along the axis, as long as the angle in radians.
vec4 rotation_quaternion(vec3 v) {
  float angle = length(v);
  // sin(a/2)/a, by its series where a is small
  float share = angle > 1.0e-3 ? sin(0.5 * angle) / angle : 0.5 - angle * angle / 48.0;
  return vec4(share * v, cos(0.5 * angle));
}
vec3 rotation_vector(vec4 q) {
  q = q.w < 0.0 ? -q : q;
  float sine = length(q.xyz);
  return sine > 1.0e-6 ? 2.0 * atan(sine, q.w) / sine * q.xyz : 2.0 * q.xyz;
}

// Normalised linear blend along the shorter way.
vec4 blended(vec4 a, vec4 b, float s) { return normalize(mix(a, dot(a, b) < 0.0 ? -b : b, s)); }
