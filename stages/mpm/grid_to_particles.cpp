#include "stages/mpm/grid_to_particles.h"

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec grid_to_particles() {
  return {.name = "mpm.grid_to_particles",
          .doc = "Velocities and velocity gradients of particles from the nodes about them, PIC and FLIP blended",
          .equation = "[M 3.4 step 7]",
          .ports = {position(Access::read), grid_velocity(Access::read, Usage::sampled),
                    grid_velocity_before(Access::read, Usage::sampled), optional_order(), velocity(Access::read_write),
                    velocity_gradient(Access::write)},
          .parameters = {kernel_parameter(),
                         {.name = "flip", .initial = 0.95, .min = 0, .max = 1, .doc = "share alpha of FLIP; the rest is PIC"}},
          .constants = {"grid_min", "grid_cell", "grid_nodes"},
          .faults = {graph::Fault::not_a_number},
          .work = {graph::Dispatch{.kernel = "mpm/grid_to_particles.comp", .over = "particles"}}};
}

}  // namespace firn::stages::mpm
