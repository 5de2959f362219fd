#include "stages/mpm/particles_to_grid.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec particles_to_grid() {
  return {.name = "mpm.particles_to_grid",
          .doc = "Scatters mass and momentum of particles to the nodes about them, one invocation per particle and node",
          .equation = "[M 3.4 step 1, M 17-20]",
          .ports = joined({{position(Access::read), velocity(Access::read), mass(Access::read)},
                           grid_mass_and_momentum_sums(Access::accumulate)}),
          .parameters = {kernel_parameter(), accumulate_parameter()},
          .constants = {"grid_min", "grid_cell", "grid_nodes", "mass_scale", "momentum_scale"},
          .faults = {graph::Fault::overflow},
          .work = over_particles_and_nodes("mpm/particles_to_grid.comp", arithmetic::weight + arithmetic::sums)};
}

}  // namespace firn::stages::mpm
