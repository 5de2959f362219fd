#include "stages/heightfield/deposit.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec deposit() {
  using enum Access;
  return {.name = "heightfield.deposit",
          .doc = "Adds the snow that arrives to the snow that lies",
          .equation = "[H 3.28]",
          .ports = mpm::joined({{port("arrived", read), optional("arrived_height", read)},
                                ports({"depth", "density"}, read_write),
                                {optional("changed_tiles", read_write)},
                                cell_choice_ports()}),
          .parameters = {cells_parameter()},
          .constants = {"min_density", "max_density"},
          .work = over_cells("heightfield/deposit.comp", {{"arrived", read},
                                                          {"arrived_height", read},
                                                          {"depth", read_write},
                                                          {"density", read_write},
                                                          {"changed_tiles", read_write}})};
}

}  // namespace firn::stages::heightfield
