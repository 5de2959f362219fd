#include "stages/mpm/clear_grid.h"

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec clear_grid() {
  return {.name = "mpm.clear_grid",
          .doc = "Sets the sums on the grid to zero",
          .equation = "[M 3.4 step 0]",
          .ports = joined({grid_sums(Access::write, Access::write), {stress_max(Access::write)}}),
          .parameters = {accumulate_parameter()},
          .work = {graph::Dispatch{.kernel = "mpm/clear_grid.comp", .over = "nodes"}}};
}

}  // namespace firn::stages::mpm
