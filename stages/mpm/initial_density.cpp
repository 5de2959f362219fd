#include "stages/mpm/initial_density.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec initial_density() {
  return {.name = "mpm.initial_density",
          .doc = "Density about every particle from the mass of the nodes, and from it the volume of the particle",
          .equation = "[M 3.4 step 2]",
          .ports = joined({{position(Access::read), mass(Access::read)},
                           by_nodes(grid_mass, Access::read),
                           stencil_ports(),
                           {density(Access::write), volume(Access::read_write)}}),
          .parameters = {kernel_parameter(), nodes_parameter()},
          .constants = {"grid_min", "grid_cell", "grid_nodes"},
          .work = {graph::Dispatch{.kernel = "mpm/initial_density.comp",
                                   .over = "particles",
                                   .arithmetic = arithmetic::per_particle(arithmetic::weight + 2)}}};
}

}  // namespace firn::stages::mpm
