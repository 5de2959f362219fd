// Grains of particles, one triangle each: three vertices over a ball.
#include "render/camera.glsl"
#include "render/random.glsl"
#include "render/sphere.glsl"

out vec3 place;  // on the triangle, m
flat out vec3 center;
flat out float size;
flat out vec4 surface;
flat out vec4 color;

#if DETAIL_SPHERES
const int most_grains = 1;
#else
const int most_grains = 27;
#endif

// As many as the picture can show: grains smaller than a pixel or two would only flicker.
float grains_for(float apparent_radius) { return clamp(pow(0.75 * apparent_radius, 3.0), 1.0, float(most_grains)); }

void main() {
  int particle = gl_VertexID / (3 * most_grains), grain = gl_VertexID / 3 % most_grains;
  float r = radius * pow(volume_at(particle), 1.0 / 3.0);
  center = position_at(particle);
  float grains = grains_for(r / (pixel_angle() * length(center - camera_from)));
  gl_Position = vec4(0.0);
  // Inside the snow only the core is drawn.
  if (grain > 0 && float(grain) >= grains * particle_shown_at(particle)) return;
  vec4 random = random_numbers(uvec2(particle, grain));
  size = r;
  if (grain > 0) {
    // Spread over a ball that reaches a little into the neighbours'.
    center += 1.25 * r * pow(random.z, 1.0 / 3.0) * on_sphere(random.xy);
    size = r * (0.5 + 0.5 * random.w) * 1.35 / pow(grains, 1.0 / 3.0);
  } else if (grains > 1.5) {
    size *= 0.8;  // a core that hides what lies behind
  }
  surface = particle_surface_at(particle);
  color = particle_color_at(particle);
  color.rgb *= 0.88 + 0.12 * random.w;
  place = sphere_corner(center, size, camera_from, gl_VertexID % 3);
  gl_Position = clip_position(place);
#if !DETAIL_SPHERES
  // Grains are so small that one depth does; then depth tests come before shading.
  gl_Position.z = gl_Position.w * (1.0 - 2.0 * near_plane / max(clip_position(center).w, near_plane));
#endif
}
