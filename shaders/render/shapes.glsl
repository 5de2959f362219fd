// Rigid bodies for rays and for ambient light. Needs the sampled ports body_kind, body_size, body_position, body_orientation.
// Kinds and sizes as in lib/bodies.glsl.

#include "lib/turn.glsl"

const float far_away = 1.0e30;

struct Hit {
  float distance;  // along the ray; far_away: nothing
  int body;
  vec3 normal;
};

float bounding_radius(int kind, vec3 size) { return kind == 1 ? size.x : kind == 3 ? size.x + size.y : length(size); }

void hit_ball(vec3 from, vec3 ray, vec3 center, float radius, inout float nearest, inout vec3 normal) {
  vec3 to_center = center - from;
  float along = dot(to_center, ray);
  vec3 beside = to_center - along * ray;
  float room = radius * radius - dot(beside, beside);
  float t = along - sqrt(max(room, 0.0));
  if (room < 0.0 || t <= 0.0 || t >= nearest) return;
  nearest = t;
  normal = (from + t * ray - center) / radius;
}

void hit_box(vec3 from, vec3 ray, vec3 half_size, inout float nearest, inout vec3 normal) {
  vec3 inverse = 1.0 / mix(ray, vec3(1.0e-9), lessThan(abs(ray), vec3(1.0e-9)));
  vec3 enter = -from * inverse - abs(inverse) * half_size;
  vec3 leave = -from * inverse + abs(inverse) * half_size;
  float t = max(enter.x, max(enter.y, enter.z));
  if (t <= 0.0 || t >= nearest || t > min(leave.x, min(leave.y, leave.z))) return;
  nearest = t;
  normal = -sign(ray) * vec3(equal(enter, vec3(t)));
}

// About the origin, its axis along y.
void hit_capsule(vec3 from, vec3 ray, float radius, float half_length, inout float nearest, inout vec3 normal) {
  float a = dot(ray.xz, ray.xz), b = dot(from.xz, ray.xz), c = dot(from.xz, from.xz) - radius * radius;
  float room = b * b - a * c;
  if (a > 1.0e-9 && room >= 0.0) {
    float t = (-b - sqrt(room)) / a;
    float y = from.y + t * ray.y;
    if (t > 0.0 && t < nearest && abs(y) <= half_length) {
      nearest = t;
      vec2 out_ward = (from.xz + t * ray.xz) / radius;
      normal = vec3(out_ward.x, 0.0, out_ward.y);
    }
  }
  hit_ball(from, ray, vec3(0.0, half_length, 0.0), radius, nearest, normal);
  hit_ball(from, ray, vec3(0.0, -half_length, 0.0), radius, nearest, normal);
}

// A body that is not a half-space: nearer than hit.distance, it takes its place. Meshes are drawn as triangles instead (meshes.vert).
void hit_solid(int b, int kind, vec3 from, vec3 ray, inout Hit hit) {
  vec4 q = body_orientation_at(b);
  vec3 size = body_size_at(b).xyz;
  vec3 local_from = turned_back(q, from - body_position_at(b)), local_ray = turned_back(q, ray);
  float nearest = hit.distance;
  vec3 normal = vec3(0.0);
  if (kind == 1) hit_ball(local_from, local_ray, vec3(0.0), size.x, nearest, normal);
  if (kind == 2) hit_box(local_from, local_ray, size, nearest, normal);
  if (kind == 3) hit_capsule(local_from, local_ray, size.x, size.y, nearest, normal);
  if (nearest < hit.distance) hit = Hit(nearest, b, turned(q, normal));
}

// Distance to the surface of a body that is not a half-space, from outside, and the direction there in xyz; of a mesh, to its box.
vec4 toward_solid(int b, int kind, vec3 x) {
  vec4 q = body_orientation_at(b);
  vec3 size = body_size_at(b).xyz;
  vec3 local = turned_back(q, x - body_position_at(b));
  vec3 core = kind == 2 || kind == 4 ? clamp(local, -size, size) : kind == 3 ? vec3(0.0, clamp(local.y, -size.y, size.y), 0.0) : vec3(0.0);
  vec3 there = core - local;
  float distance = length(there);
  return vec4(distance > 0.0 ? turned(q, there / distance) : vec3(0.0), distance - (kind == 2 || kind == 4 ? 0.0 : size.x));
}
