// What most rays need of a body. Half-spaces: unit normal and its product with a point of the plane; others: a ball round them.
#if HAS_BODY_KIND
#include "render/shapes.glsl"
#endif

void main() {
#if HAS_BODY_KIND
  uint index = element_index();
  if (index >= bodies_count) return;
  int b = int(index);
  int kind = body_kind_at(b);
  vec3 place = body_position_at(b), normal = turned(body_orientation_at(b), vec3(0.0, 1.0, 0.0));
  body_bound[index] = kind == 0 ? vec4(normal, dot(normal, place)) : vec4(place, bounding_radius(kind, body_size_at(b).xyz));
#endif
}
