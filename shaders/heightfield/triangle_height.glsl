// The height of a triangle's plane over a place; of an almost vertical one, held between its corners.
float triangle_height(vec3 a, vec3 b, vec3 c, vec2 at) {
  vec3 normal = cross(b - a, c - a);
  float low = min(a.y, min(b.y, c.y)), high = max(a.y, max(b.y, c.y));
  if (!(abs(normal.y) > 0.0)) return low;
  return clamp(a.y - dot(normal.xz, at - a.xz) / normal.y, low, high);
}
