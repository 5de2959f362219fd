// Where a body is, and where it was a step before where that is known. Needs the sampled ports body_position and
// body_orientation; optional body_position_before and body_orientation_before.
#include "lib/turn.glsl"

struct Pose {
  vec3 place;
  vec4 turn;
};

Pose pose(int body) { return Pose(body_position_at(body), body_orientation_at(body)); }
Pose pose_before(int body) {
#if HAS_BODY_POSITION_BEFORE && HAS_BODY_ORIENTATION_BEFORE
  return Pose(body_position_before_at(body), body_orientation_before_at(body));
#else
  return pose(body);
#endif
}
vec3 placed(Pose at, vec3 own) { return at.place + turned(at.turn, own); }
