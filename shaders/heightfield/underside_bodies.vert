// What a sphere, a capsule, or a box that keeps its orientation passes through in a step. Ball and capsule: balls along the segments from its
// ends before to its ends now, and for a capsule along its axis before and now; between them the underside of the parallelogram that its
// axis sweeps. Five quads per body. Box: six parallelograms.
#include "heightfield/underside_clip.glsl"
#include "lib/body_pose.glsl"

flat out int body;
flat out float radius;           // of the balls; negative: the triangle below
flat out vec3 a, b, c;           // the segment a b, or a triangle

const vec2 corners[6] = vec2[6](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));

// A box and its way make a sum of four segments: its edges and the way. Each two of them span one parallelogram of the underside, and the six
// cover it without overlapping: the other two segments end there on the side that the parallelogram, seen from below, looks to. Where
// three segments lie in a plane, the signs of the way's parts along the edges still place the three parallelograms side by side.
struct SweptBox {
  vec3 middle;
  vec3 edges[3];  // halves
  vec3 way;       // half
  vec3 ahead;     // signs of the way along the edges
};

// All corners add up in one order, so that neighbours share theirs to the bit.
vec3 swept_corner(SweptBox box, vec4 signs) {
  return box.middle + signs.x * box.edges[0] + signs.y * box.edges[1] + signs.z * box.edges[2] + signs.w * box.way;
}

// Part 0 to 2: spanned by edges `part` and `part + 1`; 3 to 5: by edge `part - 3` and the way. Signs along the next edges in turn.
vec4 swept_signs(SweptBox box, int part, vec2 corner, float side) {
  int m = part % 3;
  vec2 at = 2.0 * corner - 1.0;
  vec3 ahead = m == 0 ? box.ahead : m == 1 ? box.ahead.yzx : box.ahead.zxy;
  vec4 signs = part < 3 ? vec4(at, side, side * ahead.z) : vec4(at.x, -side * ahead.z, side * ahead.y, at.y);
  return m == 0 ? signs : m == 1 ? signs.zxyw : signs.yzxw;
}

void main() {
  body = gl_InstanceID;
  int part = gl_VertexID / 6, kind = body_kind_at(body);
  vec4 size = body_size_at(body);
  vec2 corner = corners[gl_VertexID % 6];
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  a = b = c = vec3(0.0);
  radius = size.x;
  bool box = kind == 2 && size.w == 0.0;
  if (!(kind == 1 && part == 0 || kind == 3 && part < 5 || box)) return;
  Pose now = pose(body), before = pose_before(body);
  if (box) {
    vec3 way = now.place - before.place;
    SweptBox swept;
    swept.middle = before.place + 0.5 * way;
    swept.edges[0] = turned(now.turn, vec3(size.x, 0.0, 0.0));
    swept.edges[1] = turned(now.turn, vec3(0.0, size.y, 0.0));
    swept.edges[2] = turned(now.turn, vec3(0.0, 0.0, size.z));
    swept.way = 0.5 * way;
    swept.ahead = mix(vec3(-1.0), vec3(1.0), greaterThanEqual(turned_back(now.turn, way), vec3(0.0)));
    int m = part % 3;
    vec3 one = m == 0 ? swept.edges[0] : m == 1 ? swept.edges[1] : swept.edges[2];
    vec3 other = part > 2 ? swept.way : m == 0 ? swept.edges[1] : m == 1 ? swept.edges[2] : swept.edges[0];
    float rise = cross(one, other).y;
    if (rise == 0.0) return;
    float side = rise > 0.0 ? -1.0 : 1.0;
    bool second = gl_VertexID % 6 >= 3;
    a = swept_corner(swept, swept_signs(swept, part, vec2(0, 0), side));
    b = swept_corner(swept, swept_signs(swept, part, second ? vec2(1, 1) : vec2(1, 0), side));
    c = swept_corner(swept, swept_signs(swept, part, second ? vec2(0, 1) : vec2(1, 1), side));
    radius = -1.0;
    gl_Position = on_field((gl_VertexID % 3 == 0 ? a : gl_VertexID % 3 == 1 ? b : c).xz);
    return;
  }
  vec3 axis = vec3(0.0, kind == 3 ? size.y : 0.0, 0.0);
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
