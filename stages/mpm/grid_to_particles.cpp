#include "stages/mpm/grid_to_particles.h"

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {
namespace {

using enum Access;

graph::ParameterSpec nodes_and_cells_parameter() {
  graph::ParameterSpec parameter = nodes_parameter();
  parameter.choices.emplace_back("by_cell");
  parameter.doc += "; by_cell: as active, and what the nodes about a cell hold is read once for all its particles";
  return parameter;
}

// What the kernel over cells needs besides position and velocity.
std::vector<Port> by_cell_ports() {
  std::vector<Port> ports{order(read, Usage::sampled),
                          active_blocks(read),
                          active_block_count(read),
                          active_groups(read, Usage::indirect),
                          block_entry(read),
                          block_cells(read, Usage::sampled),
                          block_near(read),
                          grid_velocity(read, Usage::sampled, block_nodes),
                          grid_velocity_before(read, Usage::sampled, block_nodes)};
  for (Port& port : ports) port = when(port, "nodes", "by_cell");
  return ports;
}

std::vector<Port> optional_orders() { return {when(optional_order(), "nodes", "all"), when(optional_order(), "nodes", "active")}; }

graph::Dispatch over_particles(const char* nodes) {
  return {.kernel = "mpm/grid_to_particles.comp", .over = "particles", .when = {"nodes", nodes}};
}

}  // namespace

graph::StageSpec grid_to_particles() {
  return {.name = "mpm.grid_to_particles",
          .doc = "Velocities and velocity gradients of particles from the nodes about them, PIC and FLIP blended",
          .equation = "[M 3.4 step 7]",
          .ports = joined({{position(read)},
                           by_nodes(grid_velocity, read, Usage::sampled),
                           by_nodes(grid_velocity_before, read, Usage::sampled),
                           stencil_ports(),
                           optional_orders(),
                           by_cell_ports(),
                           {velocity(read_write), velocity_gradient(write)}}),
          .parameters = {kernel_parameter(),
                         nodes_and_cells_parameter(),
                         {.name = "flip", .initial = 0.95, .min = 0, .max = 1, .doc = "share alpha of FLIP; the rest is PIC"}},
          .constants = {"grid_min", "grid_cell", "grid_nodes"},
          .faults = {graph::Fault::not_a_number},
          .work = {over_particles("all"), over_particles("active"),
                   graph::Dispatch{.kernel = "mpm/grid_to_particles_by_cell.comp",
                                   .over = "",
                                   .indirect = "active_groups",
                                   .group = 16,
                                   .when = {"nodes", "by_cell"}}}};
}

}  // namespace firn::stages::mpm
