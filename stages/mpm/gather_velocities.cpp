#include "stages/mpm/gather_velocities.h"

#include "stages/mpm_arithmetic.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {
namespace {

using enum Access;
using graph::Dispatch;
using graph::Work;

constexpr double per_node = arithmetic::weight + arithmetic::sums + arithmetic::weight_gradient + arithmetic::force;

graph::ParameterSpec form_parameter() {
  return {.name = "form",
          .kind = graph::ParameterKind::choice,
          .initial = std::string("auto"),
          .choices = {"auto", "texture", "shared", "subgroup"},
          .doc =
              "texture: every node reads its particles, by texture fetches; shared: every block adds up what its particles give in "
              "shared memory, then blocks are put together; subgroup: as shared, waiting for subgroups only; auto: as the device "
              "calls for"};
}

// Particles are packed first, in sorted order: whole texels one after another are what software renderers read fastest, and three
// of them hold all that is asked of a particle.
std::vector<Port> texture_ports() {
  return {when({.name = "packed_particles",
                .type = ElementType::vec4,
                .domain = "particles*3",
                .access = read_write,
                .unit = "mixed",
                .doc = "position in the cell, mass, velocity and stress, but for yz, of particles in sorted order",
                .repeatable = false},
               "form", "texture"),
          when({.name = "packed_stress",
                .type = ElementType::float1,
                .domain = "particles",
                .access = read_write,
                .unit = "J",
                .doc = "stress yz of particles in sorted order",
                .repeatable = false},
               "form", "texture")};
}
std::vector<Work> texture_work() {
  const graph::Condition texture{"form", "texture"};
  return {Dispatch{.kernel = "mpm/gather_pack.comp",
                   .over = "particles",
                   .uses = {{"position", read},
                            {"velocity", read},
                            {"mass", read},
                            {"stress", read},
                            {"order", read},
                            {"packed_particles", write},
                            {"packed_stress", write}},
                   .when = texture},
          Dispatch{.kernel = "mpm/gather_velocities.comp",
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
                            {"grid_velocity", write}},
                   .when = texture,
                   .arithmetic = arithmetic::per_particle(per_node)}};
}

// Particles are read once, from where they lie.
std::vector<Port> block_ports(const char* form) {
  return {when(block_entry(read), "form", form), when(block_slot(read), "form", form),
          when({.name = "block_sums",
                .type = ElementType::float1,
                .domain = block_sum_values,
                .access = write,  // and read again, by the same stage
                .unit = "mixed",
                .doc = "mass, momentum and force that a block's particles give to the 7 x 7 x 7 nodes that they reach",
                .repeatable = false},
               "form", form)};
}
std::vector<Work> block_work(const char* form) {
  const graph::Condition here{"form", form};
  return {Dispatch{.kernel = "mpm/gather_block_sums.comp",
                   .over = "",
                   .indirect = "active_groups",
                   .uses = {{"position", read},
                            {"velocity", read},
                            {"mass", read},
                            {"stress", read},
                            {"order", read},
                            {"block_cells", read},
                            {"block_entry", read},
                            {"active_blocks", read},
                            {"active_block_count", read},
                            {"block_sums", write}},
                   .when = here,
                   .arithmetic = arithmetic::per_particle(per_node)},
          Dispatch{.kernel = "mpm/gather_blocks.comp",
                   .over = "",
                   .indirect = "active_groups",
                   .uses = {{"block_cells", read},
                            {"block_slot", read},
                            {"active_block_count", read},
                            {"block_near", read},
                            {"block_sums", read},
                            {"grid_mass", write},
                            {"grid_velocity_before", write},
                            {"grid_velocity", write}},
                   .when = here}};
}

}  // namespace

graph::StageSpec gather_velocities() {
  std::vector<Work> work = texture_work();
  for (const char* form : {"shared", "subgroup"})
    for (Work& one : block_work(form)) work.push_back(std::move(one));
  return {.name = "mpm.gather_velocities",
          .doc =
              "Mass and velocities of the nodes of stored blocks, gathered from sorted particles: what gather_to_grid and "
              "grid_update do, in one",
          .equation = "[M 3.4 steps 1, 3, 4]",
          .ports = joined({{position(read, Usage::sampled), velocity(read, Usage::sampled), mass(read, Usage::sampled),
                            stress(read, Usage::sampled), order(read, Usage::sampled)},
                           texture_ports(),
                           {block_cells(read, Usage::sampled), active_blocks(read), active_block_count(read), block_near(read),
                            active_groups(read, Usage::indirect)},
                           block_ports("shared"),
                           block_ports("subgroup"),
                           {grid_mass(write, Usage::storage, block_nodes), grid_velocity_before(write, Usage::storage, block_nodes),
                            grid_velocity(write, Usage::storage, block_nodes)}}),
          .parameters = {kernel_parameter(), form_parameter()},
          .constants = {"grid_min", "grid_cell", "grid_nodes", "gravity"},
          .work = std::move(work)};
}

}  // namespace firn::stages::mpm
