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

// As many as the picture can show: grains smaller than a pixel or two would only flicker. Inside the snow only the core is left.
int grains_of(int particle, float apparent_radius) {
  float wanted = pow(0.75 * apparent_radius, 3.0) * particle_shown_at(particle);
  return clamp(int(wanted), 1, most_grains);
}

void main() {
  int particle = gl_VertexID / (3 * most_grains), grain = gl_VertexID / 3 % most_grains;
  float r = radius * pow(volume_at(particle), 1.0 / 3.0);
  center = position_at(particle);
  int grains = grains_of(particle, r / (pixel_angle() * length(center - camera_from)));
  gl_Position = vec4(0.0);
  if (grain >= grains) return;
  vec4 random = random_numbers(uvec2(particle, grain));
  size = r;
  if (grain > 0) {
    // Spread over a ball that reaches a little into the neighbours'.
    center += 1.25 * r * pow(random.z, 1.0 / 3.0) * on_sphere(random.xy);
    size = r * (0.5 + 0.5 * random.w) * 1.35 / pow(float(grains), 1.0 / 3.0);
  } else if (grains > 1) {
    size *= 0.8;  // a core that hides what lies behind
  }
  surface = particle_surface_at(particle);
  color = particle_color_at(particle);
  color.rgb *= 0.93 + 0.07 * random.w;
  place = sphere_corner(center, size, camera_from, gl_VertexID % 3);
  gl_Position = clip_position(place);
}
