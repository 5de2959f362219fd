// Sun and sky at the corners of the snow's surface.
#include "render/shadow.glsl"
#include "render/sunlight.glsl"
#if HAS_BODY_KIND
#include "render/shapes.glsl"
#include "render/occlusion.glsl"
#endif

void main() {
  uint index = element_index();
  if (index >= surface_corners_count) return;
  vec3 normal = surface_normal_at(int(index));
  vec2 light = vec2(0.0);
  if (normal != vec3(0.0)) {
    vec3 x = surface_corner_at(int(index));
    // Off the surface by half a cell, as the particles that cast its shadow reach about as far.
    light = vec2(sunlit(x + 0.5 * grid_cell * normal, 0.1 * grid_cell, 0.8 * grid_cell), 1.0);
#if HAS_BODY_KIND
    light.y = sky_left_by_bodies(x, normal, -1);
#endif
  }
  surface_light[index] = light;
}
