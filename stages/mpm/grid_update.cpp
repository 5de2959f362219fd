#include "stages/mpm/grid_update.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec grid_update() {
  return {.name = "mpm.grid_update",
          .doc = "Velocities of nodes from mass and momentum, then one step of forces and gravity",
          .equation = "[M 3.4 step 4]",
          .ports = joined({grid_sums(Access::read, Access::read),
                           {stress_max(Access::read), grid_mass(Access::write), grid_velocity_before(Access::write),
                            grid_velocity(Access::write)}}),
          .parameters = {accumulate_parameter()},
          .constants = {"grid_min", "grid_cell", "grid_nodes", "mass_scale", "momentum_scale", "crowd", "gravity"},
          .work = {graph::Dispatch{
              .kernel = "mpm/grid_update.comp", .over = "nodes", .arithmetic = {{"nodes", arithmetic::node_solve}}}}};
}

}  // namespace firn::stages::mpm
