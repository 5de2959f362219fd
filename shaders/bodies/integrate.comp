// Rigid bodies over one step: along their key frames, by gravity and forces where they have a mass, else as told.
#include "lib/quaternion.glsl"
#include "lib/turn.glsl"

// The pose on a body's path at a time; before the first and after the last key frame it rests there.
void pose_at(int first, int count, float t, out vec3 place, out vec4 turn) {
  int k = first;
  while (k < first + count - 2 && t >= path_time[k + 1]) ++k;
  int next = min(k + 1, first + count - 1);
  float span = path_time[next] - path_time[k];
  float s = span > 0.0 ? clamp((t - path_time[k]) / span, 0.0, 1.0) : 0.0;
  place = mix(path_position[k], path_position[next], s);
  turn = blended(path_orientation[k], path_orientation[next], s);
}

#if HAS_BODY_INERTIA
// Angular velocity that an angular impulse (world axes) gives a body.
vec3 spun(uint b, vec4 turn, vec3 impulse) {
  vec3 moments = body_inertia[b], own = turned_back(turn, impulse);
  return turned(turn, vec3(moments.x > 0.0 ? own.x / moments.x : 0.0, moments.y > 0.0 ? own.y / moments.y : 0.0, moments.z > 0.0 ? own.z / moments.z : 0.0));
}
#endif

// Gives a body the impulse `size` along the unit vector `along` at a point, but no more than stops the point's motion against it: what
// snow does to a body can hold it up, not throw it back.
void push(uint b, vec4 turn, vec3 arm, vec3 along, float size, inout vec3 velocity, inout vec3 spin) {
  float against = -dot(velocity + cross(spin, arm), along);
  if (!(against > 0.0)) return;
  float yielding = 1.0 / body_mass[b];
#if HAS_BODY_INERTIA
  vec3 lever = cross(arm, along);
  yielding += dot(lever, spun(b, turn, lever));
#endif
  float impulse = min(size, against / yielding);
  velocity += impulse / body_mass[b] * along;
#if HAS_BODY_INERTIA
  spin += spun(b, turn, impulse * lever);
#endif
}

void main() {
  uint b = element_index();
  if (b >= bodies_count) return;
  vec3 place = body_position[b];
  vec4 turn = body_orientation[b];
#if HAS_BODY_POSITION_BEFORE
  body_position_before[b] = place;
#endif
#if HAS_BODY_ORIENTATION_BEFORE
  body_orientation_before[b] = turn;
#endif
  ivec2 path = body_path[b];
  if (path.y > 0) {
    vec3 next_place;
    vec4 next_turn;
    pose_at(path.x, path.y, time + dt, next_place, next_turn);
    body_velocity[b] = dt > 0.0 ? (next_place - place) / dt : vec3(0.0);
    body_spin[b] = dt > 0.0 ? rotation_vector(product(next_turn, conjugated(turn))) / dt : vec3(0.0);
    place = next_place;
    turn = next_turn;
  } else {
    vec3 velocity = body_velocity[b], spin = body_spin[b];
    if (body_mass[b] > 0.0) {
      velocity += dt * gravity;
#if HAS_RESISTANCE && HAS_CONTACT_POINT
      float force = length(resistance[b]);
      if (force > 0.0) push(b, turn, contact_point[b] - place, resistance[b] / force, dt * force, velocity, spin);
#endif
#if HAS_SUPPORT && HAS_SUPPORT_POINT
      if (support[b] > 0.0) push(b, turn, support_point[b] - place, vec3(0.0, 1.0, 0.0), dt * support[b], velocity, spin);
#endif
    }
    place += dt * velocity;
    turn = normalize(product(rotation_quaternion(dt * spin), turn));
    body_velocity[b] = velocity;
    body_spin[b] = spin;
  }
  body_position[b] = place;
  body_orientation[b] = turn;
}
