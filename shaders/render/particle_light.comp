// What the draw needs to know of every particle: its colour, the normal of the snow it belongs to, and how much sun and sky it gets.
#include "render/shadow.glsl"
#include "render/light.glsl"
#include "render/sunlight.glsl"
#if HAS_BODY_KIND
#include "render/shapes.glsl"
#include "render/occlusion.glsl"
#endif
#if HAS_GRID_MASS
#define KERNEL_CUBIC 0
#include "lib/stencil_rows.glsl"

// Density of snow in w, its gradient in xyz, from the mass of the grid's nodes.
vec4 density_about(uint particle, vec3 position) {
  Stencil stencil = stencil_of(particle, position);
  vec3 u = stencil.u;
  vec4 wx = spline4(u.x), wy = spline4(u.y), wz = spline4(u.z);
  vec4 dx = spline_slope4(u.x), dy = spline_slope4(u.y), dz = spline_slope4(u.z);
  vec4 sum = vec4(0.0);
  for (int k = 0; k < stencil_width; ++k)
    for (int j = 0; j < stencil_width; ++j) {
      StencilRow row = stencil_row(stencil, j, k);
      vec3 mass = vec3(grid_mass_at(stored_node(row, 0)), grid_mass_at(stored_node(row, 1)), grid_mass_at(stored_node(row, 2)));
      float along = dot(wx.xyz, mass);
      sum += vec4(dot(dx.xyz, mass) * wy[j] * wz[k], along * dy[j] * wz[k], along * wy[j] * dz[k], along * wy[j] * wz[k]);
    }
  return sum / (grid_cell * grid_cell * grid_cell) / vec4(vec3(grid_cell), 1.0);
}
#endif

// From blue over white to red.
vec3 scale_color(float s) {
  const vec3 low = vec3(0.06, 0.22, 0.70), middle = vec3(0.85, 0.86, 0.84), high = vec3(0.72, 0.05, 0.04);
  return s < 0.5 ? mix(low, middle, 2.0 * s) : mix(middle, high, 2.0 * s - 1.0);
}

vec3 color_of(int particle, vec3 own) {
  float compression = 0.0, speed = 0.0;
#if HAS_PLASTIC_DET
  compression = (1.0 - plastic_det_at(particle)) / compression_range;
#endif
#if HAS_VELOCITY
  speed = length(velocity_at(particle)) / speed_range;
#endif
#if COLOR_BY_SPEED
  return scale_color(clamp(speed, 0.0, 1.0));
#elif COLOR_BY_COMPRESSION
  return scale_color(clamp(0.5 + 0.5 * compression, 0.0, 1.0));
#else
  // Pressed snow holds less air, scatters less and lets its ice be seen.
  return own * mix(vec3(1.0), vec3(0.66, 0.77, 0.88), clamp(compression, 0.0, 1.0));
#endif
}

void main() {
  uint index = element_index();
  if (index >= particles_count) return;
  int particle = int(index);
  vec3 x = position_at(particle);
  vec4 look = material_look_at(material_at(particle));
  vec3 normal = vec3(0.0);
  float open = 1.0, shown = 1.0;
#if HAS_GRID_MASS
#if NODES_ACTIVE
  if (particle_cell[index] != 0xffffffffu)  // else it has come just now, and no block is known for it
#endif
  {
    vec4 density = density_about(index, x);
    // Where density falls off within a cell or two there is a surface; deep inside there is none.
    normal = -density.xyz * grid_cell / max(density.w, 0.05 * look.w);
    float steepness = length(normal);
    shown = smoothstep(0.1, 0.3, steepness);
    normal *= steepness > 0.0 ? min(1.0, 1.6 * steepness) / steepness : 0.0;
    open = 1.0 - 0.45 * smoothstep(0.45, 1.05, density.w / look.w);
  }
#endif
#if HAS_BODY_KIND
  open *= sky_left_by_bodies(x, normal, -1);
#endif
  particle_surface[index] = vec4(normal, sunlit(x, 0.1 * grid_cell, 0.8 * grid_cell));
  particle_shown[index] = shown;
  particle_color[index] = vec4(color_of(particle, linear(look.rgb)), open);
}
