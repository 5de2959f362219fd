#include "stages/mpm/gather_to_grid.h"

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

// Particles are packed in sorted order first: reading whole texels one after another is what software renderers do fastest.
graph::StageSpec gather_to_grid() {
  using enum Access;
  const auto sums = [](std::vector<Port> ports) {
    std::erase_if(ports, [](const Port& port) { return port.when.value != "float"; });
    for (Port& port : ports) port.when = {};
    return ports;
  };
  const auto gather = [](const char* nodes) {
    const bool all = std::string_view(nodes) == "all";
    return graph::Dispatch{.kernel = "mpm/gather_to_grid.comp",
                           .over = all ? "nodes" : "",
                           .indirect = all ? "" : "active_groups",
                           .uses = {{"packed_state", read, Usage::sampled},
                                    {"packed_mass", read, Usage::sampled},
                                    {"cell_start", read},
                                    {"active_blocks", read},
                                    {"active_block_count", read},
                                    {"grid_mass_sum", write},
                                    {"grid_momentum_sum", write},
                                    {"grid_force_sum", write}},
                           .when = {"nodes", nodes}};
  };
  return {.name = "mpm.gather_to_grid",
          .doc =
              "Mass, momentum and forces of nodes, gathered from sorted particles: what clear_grid, particles_to_grid and "
              "grid_forces do "
              "with `accumulate: float`, without atomics",
          .equation = "[M 3.4 steps 1, 3]",
          .ports = joined({{
                               position(read),
                               velocity(read),
                               mass(read),
                               stress(read),
                               order(read),
                               cell_start(read, Usage::sampled),
                               {.name = "packed_state",
                                .type = ElementType::vec4,
                                .domain = "particles*3",
                                .access = read_write,
                                .unit = "mixed",
                                .doc = "position, velocity and stress of particles in sorted order"},
                               {.name = "packed_mass",
                                .type = ElementType::float1,
                                .domain = "particles",
                                .access = read_write,
                                .unit = "kg",
                                .doc = "mass of particles in sorted order"},
                           },
                           sums(grid_sums(write, write)),
                           node_choice_ports()}),
          .parameters = {kernel_parameter(), nodes_parameter()},
          .constants = {"grid_min", "grid_cell", "grid_nodes"},
          .work = {
              graph::Dispatch{.kernel = "mpm/gather_pack.comp",
                              .over = "particles",
                              .uses = {{"position", read},
                                       {"velocity", read},
                                       {"mass", read},
                                       {"stress", read},
                                       {"order", read},
                                       {"packed_state", write},
                                       {"packed_mass", write}}},
              gather("all"),
              gather("active"),
          }};
}

}  // namespace firn::stages::mpm
