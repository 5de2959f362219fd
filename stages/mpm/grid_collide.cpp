#include "stages/mpm/grid_collide.h"

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec grid_collide() {
  std::vector<graph::Work> work = over_nodes("mpm/grid_collide.comp");
  for (graph::Work& one : work) std::get<graph::Dispatch>(one).needs = "bodies";
  return {.name = "mpm.grid_collide",
          .doc = "Rigid bodies act on the nodes inside them, with friction",
          .equation = "[M 4.4, 3.4 step 5]",
          .ports = joined({by_nodes(grid_mass, Access::read), by_nodes(grid_velocity, Access::read_write),
                           bodies(Access::read, Usage::sampled), node_choice_ports()}),
          .parameters = {nodes_parameter()},
          .constants = {"grid_min", "grid_cell", "grid_nodes"},
          .work = work};
}

}  // namespace firn::stages::mpm
