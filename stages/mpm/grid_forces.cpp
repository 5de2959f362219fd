#include "stages/mpm/grid_forces.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec grid_forces() {
  return {.name = "mpm.grid_forces",
          .doc = "Scatters the forces of stressed particles to the nodes about them, one invocation per particle and node",
          .equation = "[M 26, 32]",
          .ports = joined(
              {{position(Access::read), stress(Access::read), stress_max(Access::read)}, grid_force_sums(Access::accumulate)}),
          .parameters = {kernel_parameter(), accumulate_parameter()},
          .constants = {"grid_min", "grid_cell", "grid_nodes", "crowd"},
          .faults = {graph::Fault::overflow},
          .work = over_particles_and_nodes("mpm/grid_forces.comp", arithmetic::weight_gradient + arithmetic::force)};
}

}  // namespace firn::stages::mpm
