#include "stages/mpm/gather_to_grid.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec gather_to_grid() {
  using enum Access;
  std::vector<Port> sums = grid_sums(write, write);
  std::erase_if(sums, [](const Port& port) { return port.when.value != "float"; });
  for (Port& port : sums) port.when = {};
  return {.name = "mpm.gather_to_grid",
          .doc =
              "Mass, momentum and forces of nodes, gathered from sorted particles: what clear_grid, particles_to_grid and "
              "grid_forces do with `accumulate: float`, without atomics",
          .equation = "[M 3.4 steps 1, 3]",
          .ports = joined({{position(read, Usage::sampled), velocity(read, Usage::sampled), mass(read, Usage::sampled),
                            stress(read, Usage::sampled), order(read, Usage::sampled), cell_start(read, Usage::sampled)},
                           sums}),
          .parameters = {kernel_parameter()},
          .constants = {"grid_min", "grid_cell", "grid_nodes"},
          .work = {graph::Dispatch{.kernel = "mpm/gather_to_grid.comp",
                                   .over = "nodes",
                                   .arithmetic = arithmetic::per_particle(arithmetic::weight + arithmetic::sums +
                                                                          arithmetic::weight_gradient + arithmetic::force)}}};
}

}  // namespace firn::stages::mpm
