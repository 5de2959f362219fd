// What a triangle of a box or a mesh passes through in a step: itself before and now, and what its edges sweep, two triangles each. Of
// that, the lowest surface is the lowest of the whole. Eight triangles per facet.
#include "heightfield/underside_clip.glsl"
#include "lib/body_pose.glsl"

flat out int body;
flat out vec3 a, b, c;

void main() {
  int facet = gl_InstanceID, part = gl_VertexID / 3;
  body = facet_body[facet];
  Pose now = pose(body), before = pose_before(body);
  vec3 old_points[3], new_points[3];
  for (int corner = 0; corner < 3; ++corner) {
    vec3 own = facet_points[3 * facet + corner];
    old_points[corner] = placed(before, own);
    new_points[corner] = placed(now, own);
  }
  if (part == 0) {
    a = old_points[0]; b = old_points[1]; c = old_points[2];
  } else if (part == 1) {
    a = new_points[0]; b = new_points[1]; c = new_points[2];
  } else {
    int from = (part - 2) / 2, to = (from + 1) % 3;
    a = old_points[from];
    if (part % 2 == 0) {
      b = old_points[to]; c = new_points[to];
    } else {
      b = new_points[to]; c = new_points[from];
    }
  }
  gl_Position = on_field((gl_VertexID % 3 == 0 ? a : gl_VertexID % 3 == 1 ? b : c).xz);
}
