#include "stages/mpm/particle_collide.h"

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec particle_collide() {
  return {.name = "mpm.particle_collide",
          .doc = "Rigid bodies act on the particles inside them, with friction",
          .equation = "[M 4.4, 3.4 step 9]",
          .ports = joined(
              {{position(Access::read, Usage::sampled), velocity(Access::read_write)}, bodies(Access::read, Usage::sampled)}),
          .work = {graph::Dispatch{.kernel = "mpm/particle_collide.comp", .over = "particles", .needs = "bodies"}}};
}

}  // namespace firn::stages::mpm
