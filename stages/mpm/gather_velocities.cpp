#include "stages/mpm/gather_velocities.h"

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

// Particles are packed first, in sorted order: whole texels one after another are what software renderers read fastest, and three
// of them hold all that is asked of a particle.
graph::StageSpec gather_velocities() {
  using enum Access;
  return {.name = "mpm.gather_velocities",
          .doc =
              "Mass and velocities of the nodes of stored blocks, gathered from sorted particles: what gather_to_grid and "
              "grid_update do, in one",
          .equation = "[M 3.4 steps 1, 3, 4]",
          .ports = {position(read, Usage::sampled),
                    velocity(read, Usage::sampled),
                    mass(read, Usage::sampled),
                    stress(read, Usage::sampled),
                    order(read, Usage::sampled),
                    {.name = "packed_particles",
                     .type = ElementType::vec4,
                     .domain = "particles*3",
                     .access = read_write,
                     .unit = "mixed",
                     .doc = "position in the cell, mass, velocity and stress, but for yz, of particles in sorted order",
                     .repeatable = false},
                    {.name = "packed_stress",
                     .type = ElementType::float1,
                     .domain = "particles",
                     .access = read_write,
                     .unit = "J",
                     .doc = "stress yz of particles in sorted order",
                     .repeatable = false},
                    block_cells(read, Usage::sampled),
                    active_blocks(read),
                    active_block_count(read),
                    block_near(read),
                    active_groups(read, Usage::indirect),
                    grid_mass(write, Usage::storage, block_nodes),
                    grid_velocity_before(write, Usage::storage, block_nodes),
                    grid_velocity(write, Usage::storage, block_nodes)},
          .parameters = {kernel_parameter()},
          .constants = {"grid_min", "grid_cell", "grid_nodes", "gravity"},
          .work = {graph::Dispatch{.kernel = "mpm/gather_pack.comp",
                                   .over = "particles",
                                   .uses = {{"position", read},
                                            {"velocity", read},
                                            {"mass", read},
                                            {"stress", read},
                                            {"order", read},
                                            {"packed_particles", write},
                                            {"packed_stress", write}}},
                   graph::Dispatch{.kernel = "mpm/gather_velocities.comp",
                                   .over = "",
                                   .indirect = "active_groups",
                                   .group = 8,
                                   .uses = {{"packed_particles", read, Usage::sampled},
                                            {"packed_stress", read, Usage::sampled},
                                            {"block_cells", read},
                                            {"active_blocks", read},
                                            {"active_block_count", read},
                                            {"block_near", read},
                                            {"grid_mass", write},
                                            {"grid_velocity_before", write},
                                            {"grid_velocity", write}}}}};
}

}  // namespace firn::stages::mpm
