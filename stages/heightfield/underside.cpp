#include "stages/heightfield/underside.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec underside() {
  using enum Access;
  std::vector<graph::PortUse> of_bodies, of_facets;
  for (std::vector<graph::PortUse>* uses : {&of_bodies, &of_facets})
    for (const char* name : {"body_kind", "body_position", "body_orientation", "body_position_before", "body_orientation_before"})
      uses->push_back({name, read, graph::Usage::sampled});
  of_bodies.push_back({"body_size", read, graph::Usage::sampled});
  for (const char* name : {"facet_points", "facet_body", "swept_facets"}) of_facets.push_back({name, read, graph::Usage::sampled});
  const graph::PortUse map_again{"underside_map", read_write, graph::Usage::framebuffer};
  const graph::PortUse depth_again{"underside_depth", read_write, graph::Usage::framebuffer};
  of_facets.push_back(map_again);
  of_facets.push_back(depth_again);
  return {.name = "heightfield.underside",
          .doc =
              "The lowest point of any body over each cell, on its way since the last step, by drawing the bodies from below; "
              "half-spaces have none",
          .equation = "[H 4.5]",
          .ports = mpm::joined(
              {{mpm::body("body_kind", read), mpm::body("body_size", read), mpm::body("body_position", read),
                mpm::body("body_orientation", read), optional_body("body_position_before", read),
                optional_body("body_orientation_before", read)},
               ports({"facet_points", "facet_body", "swept_facets"}, read),
               {port("underside", read_write), port("owner", read_write), port("underside_map", write, graph::Usage::framebuffer),
                port("underside_depth", write, graph::Usage::framebuffer), optional("changed_tiles", read_write)},
               cell_choice_ports()}),
          .parameters = {cells_parameter()},
          .constants = field_constants(),
          .work = sequence({{graph::Draw{.name = "bodies",
                                         .vertex = "heightfield/underside_bodies.vert",
                                         .fragment = "heightfield/underside_bodies.frag",
                                         .colors = {"underside_map"},
                                         .depth = "underside_depth",
                                         .instances = "bodies",
                                         .vertices = "36",
                                         .clear = true,
                                         .uses = of_bodies},
                             graph::Draw{.name = "facets",
                                         .vertex = "heightfield/underside_facets.vert",
                                         .fragment = "heightfield/underside_facets.frag",
                                         .colors = {"underside_map"},
                                         .depth = "underside_depth",
                                         .instances = "swept_facets",
                                         .vertices = "24",
                                         .uses = of_facets}},
                            over_cells("heightfield/underside.comp", {{"underside_map", read, graph::Usage::sampled},
                                                                      {"underside_depth", read, graph::Usage::sampled},
                                                                      {"underside", read_write},
                                                                      {"owner", read_write},
                                                                      {"changed_tiles", read_write}})})};
}

}  // namespace firn::stages::heightfield
