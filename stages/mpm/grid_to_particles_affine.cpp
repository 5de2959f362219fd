#include "stages/mpm/grid_to_particles_affine.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec grid_to_particles_affine() {
  using enum Access;
  return {.name = "mpm.grid_to_particles_affine",
          .doc =
              "Velocities of particles and their affine part C_p, which is the velocity gradient too, from the stored nodes about "
              "them by APIC; quadratic kernel",
          .equation = "v_p = sum w v_i, C_p = (4/h^2) sum w v_i (x_i - x_p)^T",
          .ports = {position(read, Usage::sampled), order(read), particle_cell(read), block_slot(read), block_near(read),
                    grid_velocity(read, Usage::sampled, block_nodes), velocity(write), velocity_gradient(write)},
          .constants = {"grid_min", "grid_cell", "grid_nodes"},
          .faults = {graph::Fault::not_a_number},
          .work = {graph::Dispatch{
              .kernel = "mpm/grid_to_particles_affine.comp",
              .over = "particles",
              .arithmetic = {{"particles", 27 * (arithmetic::weight + arithmetic::interpolation + 3 + arithmetic::gradient)}}}}};
}

}  // namespace firn::stages::mpm
