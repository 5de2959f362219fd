#include "stages/heightfield/active_tiles.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {
namespace {

Port before(const char* name) {
  Port result = mpm::body(name, Access::read);
  result.optional = true;
  return result;
}

// Not read: it gives the kernels the field's width and height.
Port extent() { return optional("depth", Access::read); }

}  // namespace

graph::StageSpec active_tiles() {
  using enum Access;
  return {.name = "heightfield.active_tiles",
          .doc =
              "Lists the tiles of 16 x 16 cells that bodies are over, or were in the last step, so that later stages leave out the "
              "rest",
          .equation = "",
          .ports =
              mpm::joined({{mpm::body("body_kind", read), mpm::body("body_size", read), mpm::body("body_position", read),
                            mpm::body("body_orientation", read), before("body_position_before"), before("body_orientation_before")},
                           ports({"tile_stamp"}, read_write),
                           ports({"active_tiles", "active_tile_groups"}, write),
                           {extent()}}),
          .constants = field_constants(),
          .work = {graph::Dispatch{.kernel = "heightfield/active_mark.comp",
                                   .over = "bodies*64",
                                   .group = 64,
                                   .uses = {{"body_kind", read},
                                            {"body_size", read},
                                            {"body_position", read},
                                            {"body_orientation", read},
                                            {"body_position_before", read},
                                            {"body_orientation_before", read},
                                            {"tile_stamp", read_write}}},
                   graph::Dispatch{.kernel = "heightfield/active_list.comp",
                                   .over = "1024",
                                   .group = 1024,
                                   .uses = {{"tile_stamp", read}, {"active_tiles", write}, {"active_tile_groups", write}}}}};
}

}  // namespace firn::stages::heightfield
