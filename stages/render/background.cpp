#include "stages/render/background.h"

#include "stages/mpm_ports.h"
#include "stages/view_ports.h"

namespace firn::stages::render {

graph::StageSpec background() {
  using enum graph::Access;
  using graph::ParameterKind;
  std::vector<graph::Port> ports{view::image(write, graph::Usage::framebuffer), view::image_depth(write),
                                 view::optional_shadow_map(), view::optional(mpm::body("body_color", read))};
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
      .work = {graph::Draw{.name = "background",
                           .vertex = "render/whole_picture.vert",
                           .fragment = "render/background.frag",
                           .colors = {"image"},
                           .depth = "image_depth",
                           .clear = true}}};
}

}  // namespace firn::stages::render
