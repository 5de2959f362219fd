#include "stages/render/shadow_map.h"

#include "stages/mpm_ports.h"
#include "stages/view_ports.h"

namespace firn::stages::render {

graph::StageSpec shadow_map() {
  using enum graph::Access;
  const graph::PortUse map_again{"shadow_map", read_write, graph::Usage::framebuffer};
  std::vector<graph::PortUse> of_meshes =
      view::sampled({"body_kind", "body_position", "body_orientation", "facet_points", "facet_body"});
  std::vector<graph::PortUse> of_particles = view::sampled({"position", "volume"});
  of_meshes.push_back(map_again);
  of_particles.push_back(map_again);
  return {.name = "render.shadow_map",
          .doc = "How far sunlight comes before it meets particles or a body; half-spaces cast no shadow",
          .equation = "",
          .ports = mpm::joined({{view::shadow_map(write, graph::Usage::framebuffer), view::optional(mpm::position(read)),
                                 view::optional(mpm::volume(read))},
                                view::optional_shapes(),
                                view::optional_facets()}),
          .parameters = {{.name = "radius",
                          .kind = graph::ParameterKind::number,
                          .initial = 0.62,
                          .min = 0.05,
                          .max = 5.0,
                          .unit = "1",
                          .doc = "of particles, in cube roots of their volume"}},
          .constants = {"sun_direction", "scene_min", "scene_max"},
          .work = {graph::Draw{.name = "bodies",
                               .vertex = "render/shadow_bodies.vert",
                               .fragment = "render/shadow_bodies.frag",
                               .depth = "shadow_map",
                               .vertices = "bodies*3",
                               .clear = true,
                               .uses = view::sampled({"body_kind", "body_size", "body_position", "body_orientation"})},
                   graph::Draw{.name = "meshes",
                               .vertex = "render/shadow_meshes.vert",
                               .fragment = "render/shadow_meshes.frag",
                               .depth = "shadow_map",
                               .vertices = "facets*3",
                               .uses = of_meshes},
                   graph::Draw{.name = "particles",
                               .vertex = "render/shadow_particles.vert",
                               .fragment = "render/shadow_particles.frag",
                               .depth = "shadow_map",
                               .vertices = "particles*3",
                               .uses = of_particles,
                               .when = {"snow", "particles"}}}};
}

}  // namespace firn::stages::render
