// One group per body: stamps the tiles that its bounding box covers, now or where it was before, and one cell around; of balls, those that the
// ball reaches.
#include "lib/cell_tiles.glsl"
#include "lib/body_pose.glsl"

// Half the extent along the world's axes of a body about its origin.
vec3 half_extent(int body, vec4 turn) {
  vec3 size = body_size_at(body).xyz;
  int kind = body_kind_at(body);
  if (kind == 1) return vec3(size.x);
  if (kind == 3) return abs(turned(turn, vec3(0.0, size.y, 0.0))) + size.x;
  return abs(turned(turn, vec3(size.x, 0.0, 0.0))) + abs(turned(turn, vec3(0.0, size.y, 0.0))) + abs(turned(turn, vec3(0.0, 0.0, size.z)));
}

float distance_to_way(vec2 from, vec2 start, vec2 way) {
  float long_2 = dot(way, way);
  return length(from - start - (long_2 > 0.0 ? clamp(dot(from - start, way) / long_2, 0.0, 1.0) : 0.0) * way);
}

void main() {
  int body = int(group_number());
  if (body >= int(bodies_count) || body_kind_at(body) == 0) return;
  Pose now = pose(body), before = pose_before(body);
  vec3 reach_now = half_extent(body, now.turn), reach_before = half_extent(body, before.turn);
  vec2 low = min(now.place.xz - reach_now.xz, before.place.xz - reach_before.xz), high = max(now.place.xz + reach_now.xz, before.place.xz + reach_before.xz);
  vec2 most = vec2(tile_edge * ivec2(tiles_width, tiles_height));
  // Clamped before they become whole numbers, which far-away bodies would overflow.
  vec2 from = (low - field_min.xz) / field_cell - 2.0, to = (high - field_min.xz) / field_cell + 2.0;
  if (any(lessThan(to, vec2(0.0))) || any(greaterThan(from, most)) || any(isnan(from)) || any(isnan(to))) return;
  ivec2 first = ivec2(clamp(from, vec2(0.0), most - 1.0)) / tile_edge, last = ivec2(clamp(to, vec2(0.0), most - 1.0)) / tile_edge;
  ivec2 extent = last - first + 1;
  int t = int(gl_LocalInvocationID.x);
  vec2 start = (before.place.xz - field_min.xz) / field_cell, way = (now.place.xz - before.place.xz) / field_cell;
  bool ball = body_kind_at(body) == 1;
  float reach = reach_now.x / field_cell + 2.0 + 0.75 * float(tile_edge);  // to the middles of tiles, which lie less than 0.75 edges from their corners
  if (t < extent.x * extent.y) do {
    ivec2 tile = first + ivec2(t % extent.x, t / extent.x);
    if (!ball || distance_to_way(float(tile_edge) * (vec2(tile) + 0.5), start, way) <= reach) tile_stamp[tile.y * tiles_width + tile.x] = step + 2u;
    t += int(gl_WorkGroupSize.x);
  } while (t < extent.x * extent.y);
}
