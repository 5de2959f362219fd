// What a triangle of a mesh, or of a box that may turn, passes through in a step: itself before and now, and what its edges sweep, two triangles each. Of
// that, the lowest surface is the lowest of the whole. Eight triangles per facet; those that cannot be seen are left out.
#include "heightfield/underside_clip.glsl"
#include "lib/body_pose.glsl"

flat out int body;
flat out vec3 a, b, c;

// Boxes are closed: unless they turn, every edge at their underside belongs to a facet that faces down. And an edge sweeps something of the outside
// only if of the two faces beside it, which are at right angles, one goes ahead and the other does not; the common edge of the two facets of a
// face, the longest of each, never does.
bool hidden_in_box(Pose before, Pose now, vec3 normal, bool sweeps, vec3 first, vec3 second, vec3 across) {
  if (distance(before.turn, now.turn) > 1.0e-6) return false;
  if (turned(before.turn, normal).y >= 0.0 && turned(now.turn, normal).y >= 0.0) return true;
  if (!sweeps) return false;
  vec3 way = turned_back(now.turn, now.place - before.place);
  bool ahead = dot(normal, way) > 0.0, beside_ahead = dot(cross(second - first, normal), way) > 0.0;
  return ahead == beside_ahead || distance(first, second) > max(distance(first, across), distance(second, across));
}

void main() {
  int facet = swept_facets_at(gl_InstanceID), part = gl_VertexID / 3;
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
  vec3 across = from == 0 ? p2 : from == 1 ? p0 : p1;
  bool rests = before.place == now.place && before.turn == now.turn;
  if (rests && part != 1 || body_kind_at(body) == 2 && hidden_in_box(before, now, normal, part > 1, first, second, across)) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  gl_Position = on_field((gl_VertexID % 3 == 0 ? a : gl_VertexID % 3 == 1 ? b : c).xz);
}
