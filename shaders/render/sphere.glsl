// A triangle that covers a sphere as seen from the camera or the sun.

const vec2 triangle_corners[3] = vec2[](vec2(-1.7320508, -1.0), vec2(1.7320508, -1.0), vec2(0.0, 2.0));

// Any two unit vectors that make a right-handed frame with the unit vector n.
void frame_about(vec3 n, out vec3 a, out vec3 b) {
  a = normalize(abs(n.y) > 0.9 ? cross(n, vec3(1.0, 0.0, 0.0)) : cross(n, vec3(0.0, 1.0, 0.0)));
  b = cross(n, a);
}

// A corner of the triangle round the outline of a sphere, in the plane that touches it in front; all corners at the camera where it is
// inside.
vec3 sphere_corner(vec3 center, float radius, vec3 eye, int corner) {
  vec3 away = center - eye;
  float distance = length(away);
  if (distance <= radius) return eye;
  vec3 a, b;
  frame_about(away / distance, a, b);
  float front = distance - radius;
  float outline = front * radius / sqrt(distance * distance - radius * radius);
  vec2 at = outline * triangle_corners[corner];
  return eye + away * (front / distance) + a * at.x + b * at.y;
}

// Distance along the unit ray to a sphere; negative where it misses.
float sphere_distance(vec3 from, vec3 ray, vec3 center, float radius) {
  vec3 to_center = center - from;
  float along = dot(to_center, ray);
  vec3 beside = to_center - along * ray;
  float room = radius * radius - dot(beside, beside);
  return room < 0.0 ? -1.0 : along - sqrt(room);
}
