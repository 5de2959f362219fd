#include "stages/mpm_ports.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "stages/mpm_arithmetic.h"

namespace firn::stages::mpm {
namespace {

using graph::Condition;

Port port(const char* name, ElementType type, const char* domain, Access access, Usage usage, const char* unit, const char* doc) {
  return {.name = name, .type = type, .domain = domain, .access = access, .usage = usage, .unit = unit, .doc = doc};
}

}  // namespace

Port position(Access access, Usage usage) {
  return port("position", ElementType::vec3, "particles", access, usage, "m", "where particles are");
}
Port velocity(Access access, Usage usage) {
  return port("velocity", ElementType::vec3, "particles", access, usage, "m/s", "velocity of particles");
}
Port mass(Access access, Usage usage) {
  return port("mass", ElementType::float1, "particles", access, usage, "kg", "mass of particles, constant");
}
Port volume(Access access, Usage usage) {
  return port("volume", ElementType::float1, "particles", access, usage, "m3", "initial volume V_p0 of particles");
}
Port density(Access access) {
  return optional(
      port("density", ElementType::float1, "particles", access, Usage::storage, "kg/m3", "initial density rho_p0 about particles"));
}
Port elastic(Access access, Usage usage) {
  return port("elastic", ElementType::mat3, "particles", access, usage, "1", "elastic part FE of the deformation gradient");
}
Port plastic_det(Access access, Usage usage) {
  return port("plastic_det", ElementType::float1, "particles", access, usage, "1",
              "determinant J_P of the plastic deformation gradient");
}
Port material(Access access, Usage usage) {
  return port("material", ElementType::int1, "particles", access, usage, "1", "number of the particle's material");
}
Port stress(Access access, Usage usage) {
  return port("stress", ElementType::mat3, "particles", access, usage, "J", "V_p0 P(FE) FE^T, symmetric");
}
Port velocity_gradient(Access access, Usage usage) {
  return port("velocity_gradient", ElementType::mat3, "particles", access, usage, "1/s",
              "grad v at particles, row: component of v");
}

Port material_elastic(Access access, Usage usage) {
  return port("material_elastic", ElementType::vec4, "materials", access, usage, "Pa, Pa, 1, kg/m3",
              "mu0, lambda0, hardening xi, density");
}
Port material_plastic(Access access, Usage usage) {
  return port("material_plastic", ElementType::vec2, "materials", access, usage, "1",
              "critical compression theta_c, critical stretch theta_s");
}

Port grid_mass(Access access, Usage usage, const char* nodes) {
  return port("grid_mass", ElementType::float1, nodes, access, usage, "kg", "mass of nodes");
}
Port grid_velocity(Access access, Usage usage, const char* nodes) {
  return port("grid_velocity", ElementType::vec3, nodes, access, usage, "m/s", "velocity of nodes, with forces and collisions");
}
Port grid_velocity_before(Access access, Usage usage, const char* nodes) {
  return port("grid_velocity_before", ElementType::vec3, nodes, access, usage, "m/s",
              "velocity of nodes before forces and collisions");
}
std::vector<Port> by_nodes(GridPort port, Access access, Usage usage) {
  return {when(port(access, usage, all_nodes), "nodes", "all"), when(port(access, usage, block_nodes), "nodes", "active")};
}

std::vector<Port> grid_mass_and_momentum_sums(Access access) {
  const char* scaled = "sum over particles, as integers times a scale";
  const char* plain = "sum over particles";
  const auto usage = Usage::storage;
  return {when(port("grid_mass_sum", ElementType::int1, "nodes", access, usage, "kg", scaled), "accumulate", "fixed"),
          when(port("grid_mass_sum", ElementType::float1, "nodes", access, usage, "kg", plain), "accumulate", "float"),
          when(port("grid_momentum_sum", ElementType::ivec3, "nodes", access, usage, "kg m/s", scaled), "accumulate", "fixed"),
          when(port("grid_momentum_sum", ElementType::vec3, "nodes", access, usage, "kg m/s", plain), "accumulate", "float")};
}
std::vector<Port> grid_force_sums(Access access) {
  return {when(port("grid_force_sum", ElementType::ivec3, "nodes", access, Usage::storage, "N",
                    "sum over particles, as integers times a scale"),
               "accumulate", "fixed"),
          when(port("grid_force_sum", ElementType::vec3, "nodes", access, Usage::storage, "N", "sum over particles"), "accumulate",
               "float")};
}
std::vector<Port> grid_sums(Access mass_and_momentum, Access force) {
  return joined({grid_mass_and_momentum_sums(mass_and_momentum), grid_force_sums(force)});
}
Port stress_max(Access access) {
  return when(port("stress_max", ElementType::uint1, "1", access, Usage::storage, "J",
                   "largest entry of all stresses in this step, as the bits of a float"),
              "accumulate", "fixed");
}

Port order(Access access, Usage usage) {
  return unrepeatable(port("order", ElementType::uint1, "particles", access, usage, "1",
                           "numbers of the particles, sorted by cell, then by number"));
}
Port optional_order() { return optional(order(Access::read)); }
Port cell_start(Access access, Usage usage) {
  return port("cell_start", ElementType::uint1, "nodes", access, usage, "1",
              "place in `order` of every cell's first particle; the next cell of the row gives its end");
}
Port active_blocks(Access access) {
  return unrepeatable(
      port("active_blocks", ElementType::uint1, "grid_blocks", access, Usage::storage, "1",
           "blocks of 4 x 4 x 4 nodes that particles reach, x fastest: block (i, j, k) has the nodes from 4 (i, j, k) on"));
}
Port particle_cell(Access access) {
  return unrepeatable(
      port("particle_cell", ElementType::uint1, "particles", access, Usage::storage, "1", "cell of every particle"));
}
Port block_cells(Access access, Usage usage) {
  return unrepeatable(port("block_cells", ElementType::uint1, "block_table*65", access, usage, "1",
                           "place in `order` of every cell's first particle, 64 cells a block, and the block's end"));
}
Port block_entry(Access access) {
  return unrepeatable(port("block_entry", ElementType::uint1, "grid_blocks", access, Usage::storage, "1",
                           "entry of the table for every block of active_blocks"));
}
Port block_slot(Access access) {
  return unrepeatable(port("block_slot", ElementType::uint1, "block_table", access, Usage::storage, "1", "place in active_blocks"));
}
Port block_near(Access access) {
  return unrepeatable(
      port("block_near", ElementType::ivec4, "grid_blocks*4", access, Usage::storage, "1",
           "the eight blocks above as entries of the table (-1: none), the eight below as places in active_blocks"));
}
BlockRoom block_room(const std::array<int, 3>& nodes, std::uint64_t particles, std::uint64_t asked) {
  std::uint64_t all = 1;
  for (const int n : nodes) all *= static_cast<std::uint64_t>(n) / 4 + 1;
  const std::uint64_t blocks = std::min(all, asked > 0 ? asked : std::max<std::uint64_t>(65'536, particles / 8));
  return {blocks, std::bit_ceil(2 * blocks)};
}
Port active_block_count(Access access) {
  return port("active_block_count", ElementType::uint1, "1", access, Usage::storage, "1", "how many of active_blocks are valid");
}
Port active_groups(Access access, Usage usage) {
  return port("active_groups", ElementType::uint1, "3", access, usage, "1",
              "size of a dispatch with one group per block of active_blocks");
}

Port body(const char* name, Access access, Usage usage) {
  struct Facts {
    const char* name;
    ElementType type;
    const char *unit, *doc;
  };
  static constexpr Facts table[] = {
      {"body_kind", ElementType::int1, "1", "0 half-space, 1 sphere, 2 box, 3 capsule, 4 mesh"},
      {"body_size", ElementType::vec4, "m",
       "sphere: radius; box: half edges, and 1 if it may turn; capsule: radius, half length along local y; mesh: farthest point "
       "along each axis"},
      {"body_position", ElementType::vec3, "m", "origin of the body; a point on the plane of a half-space"},
      {"body_orientation", ElementType::vec4, "1", "quaternion x, y, z, w; a half-space's outward normal is local +y"},
      {"body_velocity", ElementType::vec3, "m/s", "velocity of the origin"},
      {"body_spin", ElementType::vec3, "rad/s", "angular velocity, world axes"},
      {"body_friction", ElementType::float1, "1", "Coulomb coefficient"},
      {"body_mass", ElementType::float1, "kg", "mass; 0: moves as told"},
      {"body_inertia", ElementType::vec3, "kg m2", "moments about the body's own axes; 0: nothing turns it"},
      {"body_position_before", ElementType::vec3, "m", "origin of the body a step before"},
      {"body_orientation_before", ElementType::vec4, "1", "orientation a step before"},
      {"body_path", ElementType::ivec2, "1", "first key frame, number of key frames"},
      {"body_color", ElementType::vec3, "1", "colour, sRGB"},
      {"body_distance_box", ElementType::vec4, "m",
       "a mesh's grid of distances: its lowest node in the body's own axes, and its cell"},
      {"body_distance_nodes", ElementType::ivec4, "1",
       "its nodes along x, y, z, and the first of them in body_distances; 0: no mesh"},
  };
  for (const Facts& facts : table)
    if (std::string_view(name) == facts.name) return port(facts.name, facts.type, "bodies", access, usage, facts.unit, facts.doc);
  throw std::logic_error(std::string("no port of bodies is called ") + name);
}
std::vector<Port> bodies(Access access, Usage usage) {
  std::vector<Port> ports;
  for (const char* name :
       {"body_kind", "body_size", "body_position", "body_orientation", "body_velocity", "body_spin", "body_friction"})
    ports.push_back(body(name, access, usage));
  for (const Port& distances : body_distances(access, Usage::sampled)) ports.push_back(optional(distances));
  return ports;
}
std::vector<Port> body_distances(Access access, Usage usage) {
  return {port("body_distances", ElementType::float1, "body_distances", access, usage, "m",
               "signed distances from meshes, negative inside, on a grid per mesh; x runs fastest"),
          body("body_distance_box", access, usage), body("body_distance_nodes", access, usage)};
}

std::vector<Port> key_frames(Access access) {
  const char* frames = "key_frames";
  return {port("path_time", ElementType::float1, frames, access, Usage::storage, "s", "times of key frames, ascending per body"),
          port("path_position", ElementType::vec3, frames, access, Usage::storage, "m", "positions at key frames"),
          port("path_orientation", ElementType::vec4, frames, access, Usage::storage, "1", "orientations at key frames")};
}

Port optional(Port port) {
  port.optional = true;
  return port;
}
Port unrepeatable(Port port) {
  port.repeatable = false;
  return port;
}
Port when(Port port, const char* parameter, const char* value) {
  port.when = Condition{parameter, value};
  return port;
}

graph::ParameterSpec kernel_parameter() {
  return {.name = "kernel",
          .kind = graph::ParameterKind::choice,
          .initial = std::string("cubic"),
          .choices = {"cubic", "quadratic"},
          .doc = "B-spline of the interpolation: cubic (64 nodes) or quadratic (27)"};
}
graph::ParameterSpec accumulate_parameter() {
  return {.name = "accumulate",
          .kind = graph::ParameterKind::choice,
          .initial = std::string("fixed"),
          .choices = {"fixed", "float"},
          .doc = "sums on the grid as scaled integers, repeatable to the bit, or as floats"};
}
graph::ParameterSpec nodes_parameter() {
  return {.name = "nodes",
          .kind = graph::ParameterKind::choice,
          .initial = std::string("all"),
          .choices = {"all", "active"},
          .doc = "all nodes of the grid, or only blocks that particles reach, as mpm.sort finds and stores them"};
}

std::vector<Port> joined(std::initializer_list<std::vector<Port>> lists) {
  std::vector<Port> all;
  for (const std::vector<Port>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

std::vector<graph::Work> over_nodes(const std::string& kernel) {
  return {graph::Dispatch{.kernel = kernel, .over = "nodes", .when = {"nodes", "all"}},
          graph::Dispatch{.kernel = kernel, .over = "", .indirect = "active_groups", .group = 64, .when = {"nodes", "active"}}};
}
std::vector<Port> node_choice_ports() {
  return {when(active_blocks(Access::read), "nodes", "active"), when(active_block_count(Access::read), "nodes", "active"),
          when(active_groups(Access::read, Usage::indirect), "nodes", "active")};
}
std::vector<Port> stencil_ports() {
  return {when(particle_cell(Access::read), "nodes", "active"), when(block_slot(Access::read), "nodes", "active"),
          when(block_near(Access::read), "nodes", "active")};
}
std::vector<graph::Work> over_particles_and_nodes(const std::string& kernel, double operations_per_node) {
  const std::vector<graph::Arithmetic> operations = arithmetic::per_particle(operations_per_node);
  return {graph::Dispatch{.kernel = kernel, .over = "particles*64", .when = {"kernel", "cubic"}, .arithmetic = operations},
          graph::Dispatch{.kernel = kernel, .over = "particles*27", .when = {"kernel", "quadratic"}, .arithmetic = operations}};
}

}  // namespace firn::stages::mpm
