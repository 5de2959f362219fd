#include "stages/mpm/advect.h"

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec advect() {
  return {.name = "mpm.advect",
          .doc = "Moves particles with their velocity; a particle that leaves the domain ends the run",
          .equation = "[M 3.4 step 10]",
          .ports = {velocity(Access::read), position(Access::read_write)},
          .constants = {"grid_min", "grid_cell", "grid_nodes"},
          .faults = {graph::Fault::not_a_number, graph::Fault::left_domain},
          .work = {graph::Dispatch{.kernel = "mpm/advect.comp", .over = "particles", .arithmetic = {{"particles", 6}}}}};
}

}  // namespace firn::stages::mpm
