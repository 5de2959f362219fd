#include "stages/mpm/grid_to_particles.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {
namespace {

using enum Access;

graph::ParameterSpec nodes_and_forms_parameter() {
  graph::ParameterSpec parameter = nodes_parameter();
  for (const char* form : {"by_cell", "by_block", "auto"}) parameter.choices.emplace_back(form);
  parameter.doc +=
      "; by_cell: as active, and what the nodes about a cell hold is read once for all its particles; by_block: the same for a "
      "block, in shared memory; auto: by_cell or by_block, as the device calls for";
  return parameter;
}

// What the kernels over cells and blocks need besides position and velocity.
std::vector<Port> stored_ports(const char* nodes) {
  std::vector<Port> ports{order(read, Usage::sampled),
                          active_blocks(read),
                          active_block_count(read),
                          active_groups(read, Usage::indirect),
                          block_entry(read),
                          block_cells(read, Usage::sampled),
                          block_near(read),
                          grid_velocity(read, Usage::sampled, block_nodes),
                          grid_velocity_before(read, Usage::sampled, block_nodes)};
  for (Port& port : ports) port = when(port, "nodes", nodes);
  return ports;
}
// Both velocities of the grid, and the gradient of the newer one.
std::vector<graph::Arithmetic> operations() {
  return arithmetic::per_particle(arithmetic::weight + arithmetic::weight_gradient + 2 * arithmetic::interpolation +
                                  arithmetic::gradient);
}
graph::Dispatch over_blocks(const char* kernel, int group, const char* nodes) {
  return {.kernel = kernel,
          .over = "",
          .indirect = "active_groups",
          .group = group,
          .when = {"nodes", nodes},
          .arithmetic = operations()};
}

std::vector<Port> optional_orders() { return {when(optional_order(), "nodes", "all"), when(optional_order(), "nodes", "active")}; }

graph::Dispatch over_particles(const char* nodes) {
  return {.kernel = "mpm/grid_to_particles.comp", .over = "particles", .when = {"nodes", nodes}, .arithmetic = operations()};
}

}  // namespace

graph::StageSpec grid_to_particles() {
  return {
      .name = "mpm.grid_to_particles",
      .doc = "Velocities and velocity gradients of particles from the nodes about them, PIC and FLIP blended",
      .equation = "[M 3.4 step 7]",
      .ports = joined({{position(read)},
                       by_nodes(grid_velocity, read, Usage::sampled),
                       by_nodes(grid_velocity_before, read, Usage::sampled),
                       stencil_ports(),
                       optional_orders(),
                       stored_ports("by_cell"),
                       stored_ports("by_block"),
                       {velocity(read_write), velocity_gradient(write)}}),
      .parameters = {kernel_parameter(),
                     nodes_and_forms_parameter(),
                     {.name = "flip", .initial = 0.95, .min = 0, .max = 1, .doc = "share alpha of FLIP; the rest is PIC"}},
      .constants = {"grid_min", "grid_cell", "grid_nodes"},
      .faults = {graph::Fault::not_a_number},
      .work = {over_particles("all"), over_particles("active"), over_blocks("mpm/grid_to_particles_by_cell.comp", 16, "by_cell"),
               over_blocks("mpm/grid_to_particles_by_block.comp", 128, "by_block")}};
}

}  // namespace firn::stages::mpm
