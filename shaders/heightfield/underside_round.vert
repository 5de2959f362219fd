// What a sphere or a capsule passes through in a step: balls along the segments from its ends before to its ends now, and for a capsule
// along its axis before and now; between them the underside of the parallelogram that its axis sweeps. Five quads per body.
#include "heightfield/underside_clip.glsl"
#include "lib/body_pose.glsl"

flat out int body;
flat out float radius;           // of the balls; negative: the triangle below
flat out vec3 a, b, c;           // the segment a b, or a triangle

const vec2 corners[6] = vec2[6](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));

void main() {
  body = gl_InstanceID;
  int part = gl_VertexID / 6, kind = body_kind_at(body);
  vec2 corner = corners[gl_VertexID % 6];
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  a = b = c = vec3(0.0);
  radius = body_size_at(body).x;
  if (!(kind == 1 && part == 0 || kind == 3)) return;
  vec3 axis = vec3(0.0, kind == 3 ? body_size_at(body).y : 0.0, 0.0);
  Pose now = pose(body), before = pose_before(body);
  vec3 low_now = placed(now, -axis), high_now = placed(now, axis), low_before = placed(before, -axis), high_before = placed(before, axis);
  if (part < 4) {
    a = part == 0 || part == 2 ? low_before : part == 1 ? high_before : low_now;
    b = part == 0 ? low_now : part == 1 || part == 3 ? high_now : high_before;
    vec2 edge = vec2(radius + field_cell);  // a cell more, so that rounding loses none
    gl_Position = on_field(mix(min(a.xz, b.xz) - edge, max(a.xz, b.xz) + edge, corner));
  } else {
    vec3 points[4] = vec3[4](low_before, high_before, high_now, low_now);
    bool second = gl_VertexID % 6 >= 3;
    vec3 one = points[0], two = second ? points[2] : points[1], three = second ? points[3] : points[2];
    vec3 normal = cross(two - one, three - one);
    if (!(abs(normal.y) > 0.0)) return;
    normal = normalize(normal) * (normal.y > 0.0 ? 1.0 : -1.0);
    a = one - radius * normal;
    b = two - radius * normal;
    c = three - radius * normal;
    radius = -1.0;
    gl_Position = on_field((gl_VertexID % 3 == 0 ? a : gl_VertexID % 3 == 1 ? b : c).xz);
  }
}
