#include "stages/mpm/gather_affine.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

// Particles are packed first, as in gather_velocities: what a node asks of one is four texels.
graph::StageSpec gather_affine() {
  using enum Access;
  return {.name = "mpm.gather_affine",
          .doc =
              "Mass and velocities of the nodes of stored blocks by APIC, with the forces of MLS-MPM and gravity, gathered from "
              "sorted particles; quadratic kernel",
          .equation = "(m v)_i = sum w (m_p v_p + A_p (x_i - x_p)), A_p = m_p C_p - dt (4/h^2) V_p0 tau_p",
          .ports = {position(read, Usage::sampled),
                    velocity(read, Usage::sampled),
                    velocity_gradient(read, Usage::sampled),
                    mass(read, Usage::sampled),
                    stress(read, Usage::sampled),
                    order(read, Usage::sampled),
                    {.name = "packed_affine",
                     .type = ElementType::vec4,
                     .domain = "particles*4",
                     .access = read_write,
                     .unit = "mixed",
                     .doc = "position in the block, mass, momentum and -h A_p of particles in sorted order",
                     .repeatable = false},
                    block_cells(read, Usage::sampled),
                    active_blocks(read),
                    active_block_count(read),
                    block_near(read),
                    active_groups(read, Usage::indirect),
                    grid_mass(write, Usage::storage, block_nodes),
                    grid_velocity(write, Usage::storage, block_nodes)},
          .constants = {"grid_min", "grid_cell", "grid_nodes", "gravity"},
          .work = {graph::Dispatch{.kernel = "mpm/gather_affine_pack.comp",
                                   .over = "particles",
                                   .uses = {{"position", read},
                                            {"velocity", read},
                                            {"velocity_gradient", read},
                                            {"mass", read},
                                            {"stress", read},
                                            {"order", read},
                                            {"packed_affine", write}}},
                   graph::Dispatch{.kernel = "mpm/gather_affine.comp",
                                   .over = "",
                                   .indirect = "active_groups",
                                   .group = 16,
                                   .uses = {{"packed_affine", read, Usage::sampled},
                                            {"block_cells", read},
                                            {"active_blocks", read},
                                            {"active_block_count", read},
                                            {"block_near", read},
                                            {"grid_mass", write},
                                            {"grid_velocity", write}},
                                   .arithmetic = {{"particles", 27 * (arithmetic::weight + 2 + arithmetic::affine_momentum)}}}}};
}

}  // namespace firn::stages::mpm
