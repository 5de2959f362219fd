// Rigid bodies as colliders with Coulomb friction [M 4.4]. Needs the ports body_kind, body_size, body_position, body_orientation,
// body_velocity, body_spin, body_friction.
// Kinds: 0 half-space (body_position on its plane, outward normal along local +y), 1 sphere (size.x: radius), 2 box (size: half edges),
// 3 capsule (size.x: radius, size.y: half the length of its axis, along local y), 4 mesh (by the sampled ports body_distances,
// body_distance_box and body_distance_nodes, where they are bound).
#include "lib/turn.glsl"

#if HAS_BODY_DISTANCES
// As body_surface, in the body's own axes: trilinear between the nodes of the mesh's grid; beyond the grid, far outside.
vec4 mesh_surface(int b, vec3 local) {
  vec4 box = body_distance_box_at(b);
  ivec4 nodes = body_distance_nodes_at(b);
  vec3 at = (local - box.xyz) / box.w;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(nodes.xyz - 1)))) return vec4(0.0, 1.0, 0.0, 1e9);
  ivec3 low = clamp(ivec3(at), ivec3(0), nodes.xyz - 2);
  vec3 f = at - vec3(low);
  float d[8];
  for (int i = 0; i < 8; ++i) {
    ivec3 node = low + ivec3(i & 1, i >> 1 & 1, i >> 2);
    d[i] = body_distances_at(nodes.w + (node.z * nodes.y + node.y) * nodes.x + node.x);
  }
  vec4 along_x = vec4(d[0], d[2], d[4], d[6]), step_x = vec4(d[1], d[3], d[5], d[7]) - along_x;
  vec4 on_x = along_x + f.x * step_x;
  vec2 on_y = mix(on_x.xz, on_x.yw, f.y);
  vec3 slope = vec3(mix(mix(step_x.x, step_x.y, f.y), mix(step_x.z, step_x.w, f.y), f.z), mix(on_x.y - on_x.x, on_x.w - on_x.z, f.z),
                    on_y.y - on_y.x);
  float steepness = length(slope);
  return vec4(steepness > 0.0 ? slope / steepness : vec3(0.0, 1.0, 0.0), mix(on_y.x, on_y.y, f.z));
}
#endif

// Signed distance to the surface (negative inside) in w, outward unit normal in the body's own axes in xyz.
vec4 body_surface(int b, vec3 x) {
  int kind = body_kind_at(b);
  vec3 local = turned_back(body_orientation_at(b), x - body_position_at(b));
  vec3 size = body_size_at(b).xyz;
  vec4 surface = vec4(0.0, 1.0, 0.0, local.y);
  if (kind == 1 || kind == 3) {
    vec3 from = kind == 1 ? local : local - vec3(0.0, clamp(local.y, -size.y, size.y), 0.0);
    float distance = length(from);
    surface = vec4(distance > 0.0 ? from / distance : vec3(0.0, 1.0, 0.0), distance - size.x);
  } else if (kind == 2) {
    vec3 beyond = abs(local) - size;
    vec3 outside = max(beyond, 0.0);
    vec3 side = vec3(local.x < 0.0 ? -1.0 : 1.0, local.y < 0.0 ? -1.0 : 1.0, local.z < 0.0 ? -1.0 : 1.0);
    float distance = length(outside);
    if (distance > 0.0) {
      surface = vec4(side * outside / distance, distance);
    } else {
      float depth = max(beyond.x, max(beyond.y, beyond.z));
      vec3 face = beyond.x == depth ? vec3(1, 0, 0) : beyond.y == depth ? vec3(0, 1, 0) : vec3(0, 0, 1);
      surface = vec4(side * face, depth);
    }
  }
#if HAS_BODY_DISTANCES
  if (kind == 4) surface = mesh_surface(b, local);
#endif
  return surface;
}

vec3 carried_by_body(int b, vec3 x) { return body_velocity_at(b) + cross(body_spin_at(b), x - body_position_at(b)); }

// The velocity v of a point x after all bodies that it lies in have acted on it, in their order.
vec3 collided(vec3 v, vec3 x) {
  int b = 0;
  if (bodies_count > 0u) do {
    vec4 surface = body_surface(b, x);
    if (surface.w > 0.0) continue;
    vec3 n = turned(body_orientation_at(b), surface.xyz);
    vec3 carried = carried_by_body(b, x);
    vec3 relative = v - carried;
    float normal_speed = dot(relative, n);
    if (normal_speed >= 0.0) continue;
    vec3 tangential = relative - n * normal_speed;
    float tangential_speed = length(tangential);
    float hold = -body_friction_at(b) * normal_speed;
    v = carried + (tangential_speed <= hold ? vec3(0.0) : tangential * (1.0 - hold / tangential_speed));
  } while (++b < int(bodies_count));
  return v;
}
