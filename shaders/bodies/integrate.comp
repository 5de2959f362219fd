// Rigid bodies over one step: along their key frames, by gravity and forces where they have a mass, else as told.
#include "lib/quaternion.glsl"

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

void main() {
  uint b = element_index();
  if (b >= bodies_count) return;
  vec3 place = body_position[b];
  vec4 turn = body_orientation[b];
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
    if (body_mass[b] > 0.0) body_velocity[b] += dt * gravity;
    place += dt * body_velocity[b];
    turn = normalize(product(rotation_quaternion(dt * body_spin[b]), turn));
  }
  body_position[b] = place;
  body_orientation[b] = turn;
}
