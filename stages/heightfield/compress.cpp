#include "stages/heightfield/compress.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec compress() {
  using enum Access;
  return {
      .name = "heightfield.compress",
      .doc = "Lowers the snow to the bodies: part of it is pressed together in place, the denser the less; the rest is pushed away",
      .equation = "[H 3.9-3.11]",
      .ports = mpm::joined({{port("overlap", read)},
                            ports({"depth", "density"}, read_write),
                            {port("displaced", write), optional("displaced_height", write), optional("changed_tiles", read_write)},
                            cell_choice_ports()}),
      .parameters = {{.name = "model",
                      .kind = graph::ParameterKind::choice,
                      .initial = std::string("conserving"),
                      .choices = {"conserving", "thesis"},
                      .doc =
                          "density of what stays: conserving keeps the snow's mass; thesis is [H 3.11] as printed, which does not"},
                     cells_parameter()},
      .constants = {"min_density", "max_density"},
      .work = over_cells("heightfield/compress.comp", {{"overlap", read},
                                                       {"depth", read_write},
                                                       {"density", read_write},
                                                       {"displaced", write},
                                                       {"displaced_height", write},
                                                       {"changed_tiles", read_write}})};
}

}  // namespace firn::stages::heightfield
