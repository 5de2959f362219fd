#include "stages/heightfield/active_tiles.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec active_tiles() {
  using enum Access;
  return {.name = "heightfield.active_tiles",
          .doc =
              "Lists the tiles of 16 x 16 cells that bodies are over, or were in the last step, so that later stages leave out the "
              "rest",
          .equation = "",
          .ports = mpm::joined({{mpm::body("body_kind", read), mpm::body("body_size", read), mpm::body("body_position", read),
                                 mpm::body("body_orientation", read), optional_body("body_position_before", read),
                                 optional_body("body_orientation_before", read)},
                                ports({"tile_stamp", "active_tile_count"}, read_write),
                                ports({"active_tiles", "active_tile_groups"}, write)}),
          .constants = field_constants(),
          .work = {graph::Dispatch{.kernel = "heightfield/active_mark.comp",
                                   .over = "bodies*32",
                                   .group = 32,
                                   .uses = {{"body_kind", read, graph::Usage::sampled},
                                            {"body_size", read, graph::Usage::sampled},
                                            {"body_position", read, graph::Usage::sampled},
                                            {"body_orientation", read, graph::Usage::sampled},
                                            {"body_position_before", read, graph::Usage::sampled},
                                            {"body_orientation_before", read, graph::Usage::sampled},
                                            {"tile_stamp", read_write}}},
                   graph::Dispatch{.kernel = "heightfield/active_list.comp",
                                   .over = "tiles",
                                   .uses = {{"tile_stamp", read}, {"active_tiles", write}, {"active_tile_count", accumulate}}},
                   graph::Dispatch{
                       .kernel = "heightfield/active_groups.comp",
                       .over = "64",
                       .group = 64,
                       .uses = {{"active_tiles", write}, {"active_tile_count", read_write}, {"active_tile_groups", write}}}}};
}

}  // namespace firn::stages::heightfield
