#include "heightfield/underside_fragment.glsl"
#include "heightfield/triangle_height.glsl"

flat in int body;
flat in float radius;
flat in vec3 a, b, c;

const float nowhere = 3.0e38;

float lowest_of_ball(vec3 center, vec2 at) {
  vec2 off = at - center.xz;
  float rest = radius * radius - dot(off, off);
  return rest > 0.0 ? center.y - sqrt(rest) : nowhere;
}

void main() {
  vec2 at = cell_center();
  if (radius < 0.0) {
    show(triangle_height(a, b, c, at), body);
    return;
  }
  float lowest = min(lowest_of_ball(a, at), lowest_of_ball(b, at));
  // The cylinder between the balls, met by the vertical line through the cell, where that lies between a and b.
  vec3 axis = b - a;
  float long_2 = dot(axis, axis), level_2 = dot(axis.xz, axis.xz);
  if (level_2 > 1.0e-12 * long_2) {
    vec2 off = at - a.xz;
    float along = dot(off, axis.xz);
    // |off + s e|^2 - ((off + s e) . axis)^2 / axis^2 = r^2 for the height s above a
    float qa = level_2, qb = -along * axis.y, qc = (dot(off, off) - radius * radius) * long_2 - along * along;
    float root = qb * qb - qa * qc;
    if (root >= 0.0) {
      float s = (-qb - sqrt(root)) / qa, share = (along + s * axis.y) / long_2;
      if (share >= 0.0 && share <= 1.0) lowest = min(lowest, a.y + s);
    }
  }
  if (lowest == nowhere) discard;
  show(lowest, body);
}
