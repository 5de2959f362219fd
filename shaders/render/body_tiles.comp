// Which bodies a ray through a tile of 16 by 16 pixels can meet: their number, then the bodies. Half-spaces are in every list.
#include "render/camera.glsl"
#include "render/tiles.glsl"

void main() {
#if HAS_BODY_KIND
  int tile = int(element_index());
  if (tile >= tiles_with_lists()) return;
  ivec2 at = ivec2(tile % tiles_across(), tile / tiles_across());
  // A cone round the tile, a pixel wider: samples lie beside the pixels' centres.
  vec2 low = float(tile_pixels) * vec2(at) - 1.0, high = low + float(tile_pixels) + 2.0;
  vec3 axis = camera_ray(0.5 * (low + high));
  float cosine = min(min(dot(axis, camera_ray(low)), dot(axis, camera_ray(high))),
                     min(dot(axis, camera_ray(vec2(low.x, high.y))), dot(axis, camera_ray(vec2(high.x, low.y)))));
  float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
  uint count = 0u;
  uint start = uint(tile * tile_list);
  for (int b = 0; b < int(bodies_count); ++b) {
    vec4 bound = body_bound_at(b);
    if (body_kind_at(b) != 0) {
      vec3 to_center = bound.xyz - camera_from;
      float along = dot(to_center, axis), beside = length(to_center - along * axis);
      if (along < -bound.w || beside * cosine - along * sine > bound.w * 1.0001 + 1.0e-5) continue;
    }
    ++count;
    if (count < uint(tile_list)) tile_bodies[start + count] = uint(b);
  }
  tile_bodies[start] = count;
#endif
}
