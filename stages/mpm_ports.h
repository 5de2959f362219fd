#pragma once

// The buffers of the material-point stages, each declared once: type, domain, unit and meaning. A stage takes what it needs.

#include <array>
#include <cstdint>

#include "graph/spec.h"

namespace firn::stages::mpm {

using graph::Access;
using graph::ElementType;
using graph::Port;
using graph::Usage;

// --- particles ---
Port position(Access access, Usage usage = Usage::storage);
Port velocity(Access access, Usage usage = Usage::storage);
Port mass(Access access, Usage usage = Usage::storage);
Port volume(Access access, Usage usage = Usage::storage);
Port density(Access access);
Port elastic(Access access, Usage usage = Usage::storage);
Port plastic_det(Access access, Usage usage = Usage::storage);
Port material(Access access, Usage usage = Usage::storage);
Port stress(Access access, Usage usage = Usage::storage);
Port velocity_gradient(Access access, Usage usage = Usage::storage);

// --- materials ---
Port material_elastic(Access access, Usage usage = Usage::storage);
Port material_plastic(Access access, Usage usage = Usage::storage);

// --- grid ---
// All nodes of the grid, or those of stored blocks (block_nodes): 64 a block, x fastest, in the order of active_blocks.
inline constexpr const char* all_nodes = "nodes";
inline constexpr const char* block_nodes = "grid_blocks*64";
// Sums over a block's particles: 7 kinds for 7 x 7 x 7 nodes (shaders/lib/block_sums.glsl).
inline constexpr const char* block_sum_values = "grid_blocks*2401";
Port grid_mass(Access access, Usage usage = Usage::storage, const char* nodes = all_nodes);
Port grid_velocity(Access access, Usage usage = Usage::storage, const char* nodes = all_nodes);
Port grid_velocity_before(Access access, Usage usage = Usage::storage, const char* nodes = all_nodes);
// A port of the grid once for every choice of the parameter `nodes`.
using GridPort = Port (*)(Access, Usage, const char* nodes);
std::vector<Port> by_nodes(GridPort port, Access access, Usage usage = Usage::storage);
// The accumulators, once as integers and once as floats; a stage that has them has the parameter `accumulate`.
std::vector<Port> grid_sums(Access mass_and_momentum, Access force);
std::vector<Port> grid_mass_and_momentum_sums(Access access);
std::vector<Port> grid_force_sums(Access access);
Port stress_max(Access access);

// --- sorted particles, active blocks ---
Port order(Access access, Usage usage = Usage::storage);
Port optional_order();  // where sorting has been done, neighbours in space are worked on together
Port cell_start(Access access, Usage usage = Usage::storage);
Port particle_cell(Access access);
Port active_blocks(Access access);
Port active_block_count(Access access);
Port active_groups(Access access, Usage usage = Usage::storage);
Port block_cells(Access access, Usage usage = Usage::storage);
Port block_entry(Access access);
Port block_slot(Access access);
Port block_near(Access access);

// Room for blocks of 4 x 4 x 4 nodes that particles reach.
struct BlockRoom {
  std::uint64_t blocks = 0;  // at most so many at once (domain grid_blocks)
  std::uint64_t table = 0;   // entries of the hash table that finds them, a power of two (domain block_table)
};
// `asked`: of the scene, 0: none. Else an eighth of the particles, at least 65,536, and never more than the grid has.
BlockRoom block_room(const std::array<int, 3>& nodes, std::uint64_t particles, std::uint64_t asked = 0);

// --- rigid bodies ---
std::vector<Port> bodies(Access access, Usage usage = Usage::storage);     // shape, pose, motion, friction
std::vector<Port> body_distances(Access access, Usage usage);              // of bodies that are meshes
std::vector<Port> key_frames(Access access);                               // of all bodies, one after another
Port body(const char* name, Access access, Usage usage = Usage::storage);  // one of them

// Of lists that are made as invocations come.
Port optional(Port port);
Port unrepeatable(Port port);
// Only where the choice parameter has this value.
Port when(Port port, const char* parameter, const char* value);

// Parameters that several stages share.
graph::ParameterSpec kernel_parameter();
graph::ParameterSpec accumulate_parameter();
graph::ParameterSpec nodes_parameter();

// Everything of the lists one after another.
std::vector<Port> joined(std::initializer_list<std::vector<Port>> lists);

// A dispatch over the nodes of the grid, or over those of the active blocks, by the parameter `nodes`.
std::vector<graph::Work> over_nodes(const std::string& kernel);
// The ports that over_nodes needs besides.
std::vector<Port> node_choice_ports();
// The ports that finding the nodes about a particle needs besides, by the parameter `nodes` (shaders/lib/stencil_rows.glsl).
std::vector<Port> stencil_ports();
// A dispatch with one invocation per particle and node of its stencil, by the parameter `kernel`.
std::vector<graph::Work> over_particles_and_nodes(const std::string& kernel, double operations_per_node);

}  // namespace firn::stages::mpm
