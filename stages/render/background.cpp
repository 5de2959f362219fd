#include "stages/render/background.h"

#include "stages/mpm_ports.h"
#include "stages/view_ports.h"

namespace firn::stages::render {

graph::StageSpec background() {
  using enum graph::Access;
  using graph::ParameterKind;
  std::vector<graph::Port> ports{view::image(write, graph::Usage::framebuffer), view::image_depth(write),
                                 view::optional_shadow_map(), view::optional(mpm::body("body_color", read))};
  ports.push_back(
      {.name = "body_bound",
       .type = graph::ElementType::vec4,
       .domain = "bodies",
       .access = read_write,
       .usage = graph::Usage::sampled,
       .unit = "mixed",
       .doc = "half-spaces: unit normal, its product with a point of the plane; others: centre and radius of a ball round them"});
  ports.push_back({.name = "tile_bodies",
                   .type = graph::ElementType::uint1,
                   .domain = "image/2",
                   .access = read_write,
                   .usage = graph::Usage::sampled,
                   .unit = "1",
                   .doc = "bodies that may be seen in tiles of 16 x 16 pixels: 64 numbers each, the first is how many"});
  const std::initializer_list<const char*> shapes{"body_kind", "body_size", "body_position", "body_orientation"};
  std::vector<graph::PortUse> of_bounds = view::sampled(shapes), of_picture = view::sampled(shapes);
  of_bounds.push_back({"body_bound", write, graph::Usage::storage});
  for (const graph::PortUse& use : view::sampled({"body_bound", "tile_bodies", "body_color", "shadow_map"}))
    of_picture.push_back(use);
  std::vector<graph::PortUse> of_tiles = view::sampled({"body_kind", "body_bound"});
  of_tiles.push_back({"tile_bodies", write, graph::Usage::storage});
  for (const graph::Port& port : view::optional_facets()) ports.push_back(port);
  std::vector<graph::PortUse> of_meshes = of_picture;
  for (const graph::PortUse& use : view::sampled({"facet_points", "facet_body"})) of_meshes.push_back(use);
  return {
      .name = "render.background",
      .doc = "Sky, ground and rigid bodies: the picture that everything else is drawn into",
      .equation = "",
      .ports = mpm::joined({ports, view::optional_shapes()}),
      .parameters = {view::exposure_parameter(),
                     {.name = "walls",
                      .kind = ParameterKind::choice,
                      .initial = std::string("glass"),
                      .choices = {"glass", "solid", "hidden"},
                      .doc =
                          "how half-spaces that are no ground look: walls and ceilings. None is drawn that the camera stands in"},
                     {.name = "ruler",
                      .kind = ParameterKind::number,
                      .initial = 0.35,
                      .min = 0.0,
                      .max = 1.0,
                      .unit = "1",
                      .doc = "how visible the metre grid on the ground is"}},
      .constants = view::constants(),
      .work = {graph::Dispatch{.kernel = "render/body_bounds.comp", .over = "bodies", .uses = of_bounds},
               graph::Dispatch{.kernel = "render/body_tiles.comp", .over = "image/128", .uses = of_tiles},
               graph::Draw{.name = "background",
                           .vertex = "render/whole_picture.vert",
                           .fragment = "render/background.frag",
                           .colors = {"image"},
                           .depth = "image_depth",
                           .clear = true,
                           .uses = of_picture},
               graph::Draw{.name = "meshes",
                           .vertex = "render/meshes.vert",
                           .fragment = "render/meshes.frag",
                           .colors = {"image"},
                           .depth = "image_depth",
                           .vertices = "facets*3",
                           .uses = of_meshes}}};
}

}  // namespace firn::stages::render
