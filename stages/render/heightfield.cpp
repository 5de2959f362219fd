#include "stages/render/heightfield.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"
#include "stages/view_ports.h"

namespace firn::stages::render {
namespace {

using graph::ElementType;
using graph::ParameterKind;
using graph::ParameterSpec;
using graph::Port;
using graph::PortUse;
using graph::Usage;

std::vector<ParameterSpec> parameters() {
  return {
      view::exposure_parameter(),
      {.name = "patches",
       .kind = ParameterKind::integer,
       .initial = std::int64_t{10},
       .min = 1.0,
       .max = 32.0,
       .doc = "patches along each side of the field"},
      {.name = "tessellation",
       .kind = ParameterKind::choice,
       .initial = std::string("constant"),
       .choices = {"constant", "distance"},
       .doc = "how finely an edge of a patch is cut: the same everywhere, or by its distance from the camera"},
      {.name = "factor",
       .kind = ParameterKind::number,
       .initial = 26.0,
       .min = 1.0,
       .max = 64.0,
       .unit = "1",
       .doc = "pieces per edge: of every edge, or t_max of the nearest in t_max (1 - clamp((distance - near) / range, 0, 1)) + 1"},
      {.name = "near",
       .kind = ParameterKind::number,
       .initial = 2.0,
       .min = 0.0,
       .max = 1.0e4,
       .unit = "m",
       .doc = "distance d_min up to which edges are cut most finely"},
      {.name = "range",
       .kind = ParameterKind::number,
       .initial = 15.0,
       .min = 1.0e-3,
       .max = 1.0e5,
       .unit = "m",
       .doc = "distance from there to where edges are not cut at all"},
      {.name = "surroundings",
       .kind = ParameterKind::choice,
       .initial = std::string("snow"),
       .choices = {"snow", "none"},
       .doc = "what lies round the field: its edge drawn out to the horizon, or nothing, so that it is a block"},
      {.name = "wireframe",
       .kind = ParameterKind::boolean,
       .initial = false,
       .doc = "the triangles' edges as dark lines, to see the tessellation"}};
}

}  // namespace

// Two kernels find heights, slopes and light per cell; the draw gives them to patches [H 4.9].
graph::StageSpec heightfield() {
  using enum graph::Access;
  const auto own = [](const char* name, ElementType type, const char* unit, const char* doc) {
    return Port{.name = name, .type = type, .domain = "cells", .access = read_write, .unit = unit, .doc = doc};
  };
  const std::vector<PortUse> of_heights{{"ground", read},
                                        {"depth", read},
                                        {"density", read},
                                        {"field_height", write, Usage::storage},
                                        {"field_look", write, Usage::storage}};
  std::vector<PortUse> of_light = view::sampled({"field_height", "body_kind", "body_size", "body_position", "body_orientation"});
  of_light.push_back({"field_slope", write, Usage::storage});
  of_light.push_back({"field_light", write, Usage::storage});
  // The most patches are (32 + 2)^2, with the ring round them. 15 in one instance make less than 2^16 vertices when cut 64 by 64;
  // Mesa's software renderer loses what goes beyond.
  const auto draw = [](const char* name, const char* fragment, std::vector<PortUse> uses) {
    return graph::Draw{.name = name,
                       .vertex = "render/heightfield.vert",
                       .fragment = fragment,
                       .tessellation_control = "render/heightfield.tesc",
                       .tessellation_evaluation = "render/heightfield.tese",
                       .colors = {"image"},
                       .depth = "image_depth",
                       .instances = "78",
                       .vertices = "15",
                       .topology = graph::Topology::patches,
                       .patch_vertices = 1,
                       .uses = std::move(uses)};
  };
  const graph::Draw surface = draw("surface", "render/heightfield.frag",
                                   view::sampled({"field_height", "field_slope", "field_light", "field_look", "shadow_map"}));
  graph::Draw lines = draw("lines", "render/heightfield_lines.frag", view::sampled({"field_height"}));
  lines.wireframe = true;
  lines.when = {"wireframe", "true"};
  std::vector<std::string> constants = view::constants();
  for (const char* name : {"field_min", "field_cell", "min_density", "max_density", "field_color"}) constants.emplace_back(name);
  const auto sampled = [](const char* name) { return stages::heightfield::port(name, read, Usage::sampled); };
  return {.name = "render.heightfield",
          .doc = "The height field as tessellated patches, in sun and sky light; pressed snow is bluer and darker",
          .equation = "[H 4.9]",
          .ports = mpm::joined(
              {{view::image(read_write, Usage::framebuffer), view::image_depth(read_write), sampled("ground"), sampled("depth"),
                view::optional(sampled("density")), view::optional_shadow_map(),
                own("field_height", ElementType::float1, "m", "height of the snow's surface"),
                // 8 bytes a cell each, so that 4096 x 4096 cells fit where a storage block holds 128 MiB.
                own("field_slope", ElementType::vec2, "m/m", "slopes along x and z"),
                own("field_light", ElementType::vec2, "1", "shares of sky and sun that arrive"),
                own("field_look", ElementType::vec2, "m, 1", "depth of the snow; 0 at its least, 1 at its largest density")},
               view::optional_shapes()}),
          .parameters = parameters(),
          .constants = constants,
          .work = {graph::Dispatch{.kernel = "render/field_height.comp", .over = "cells", .uses = of_heights},
                   graph::Dispatch{.kernel = "render/field_light.comp", .over = "cells", .uses = of_light}, surface, lines}};
}

}  // namespace firn::stages::render
