// What a triangle of a box or a mesh passes through in a step: itself before and now, and what its edges sweep, two triangles each. Of
// that, the lowest surface is the lowest of the whole. Eight triangles per facet; those that cannot be seen are left out: what a resting body
// would sweep, and facets of boxes that face up, for boxes are closed and every edge at their underside belongs to a facet that faces down. A face
// of a box is two facets; their common edge, the longest, lies within it, and what it sweeps without turning lies within what the face sweeps.
#include "heightfield/underside_clip.glsl"
#include "lib/body_pose.glsl"

flat out int body;
flat out vec3 a, b, c;

bool faces_up(vec4 turn, vec3 own_normal) { return turned(turn, own_normal).y >= 0.0; }

void main() {
  int facet = gl_InstanceID, part = gl_VertexID / 3;
  body = facet_body_at(facet);
  Pose now = pose(body), before = pose_before(body);
  vec3 p0 = facet_points_at(3 * facet), p1 = facet_points_at(3 * facet + 1), p2 = facet_points_at(3 * facet + 2), normal = cross(p1 - p0, p2 - p0);
  int from = part < 2 ? 0 : (part - 2) / 2;
  vec3 first = from == 0 ? p0 : from == 1 ? p1 : p2, second = from == 0 ? p1 : from == 1 ? p2 : p0;
  bool odd = (part & 1) == 1;
  Pose middle = odd ? now : before;
  a = placed(part == 1 ? now : before, first);
  b = placed(middle, second);
  c = placed(part == 0 ? before : now, part < 2 ? p2 : odd ? first : second);
  bool sweeps = part > 1, turns = before.turn != now.turn, box = body_kind_at(body) == 2;
  vec3 across = from == 0 ? p2 : from == 1 ? p0 : p1;
  bool longest = distance(first, second) > max(distance(first, across), distance(second, across));
  if (!turns && before.place == now.place && part != 1 || box && faces_up(before.turn, normal) && faces_up(now.turn, normal) ||
      box && sweeps && !turns && longest) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  gl_Position = on_field((gl_VertexID % 3 == 0 ? a : gl_VertexID % 3 == 1 ? b : c).xz);
}
