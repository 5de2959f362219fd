#include "stages/mpm/active_blocks.h"

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

graph::StageSpec active_blocks_stage() {
  using enum Access;
  const auto own = [](const char* name, const char* domain, const char* doc) {
    return Port{.name = name, .type = ElementType::uint1, .domain = domain, .access = read_write, .unit = "1", .doc = doc};
  };
  return {.name = "mpm.active_blocks",
          .doc =
              "Lists the blocks of the grid that particles reach, so that later stages leave out empty space; clears the blocks of "
              "the last step",
          .equation = "",
          .ports = {position(read), order(read), cell_start(read), active_blocks(read_write), active_block_count(read_write),
                    active_groups(read_write), grid_mass(write), grid_velocity(write), grid_velocity_before(write),
                    own("block_mark", "grid_blocks", "1 where particles reach the block"),
                    own("block_counter", "1", "length of the list")},
          .constants = {"grid_min", "grid_cell", "grid_nodes"},
          .work = {
              graph::Dispatch{.kernel = "mpm/clear_active.comp",
                              .over = "",
                              .indirect = "active_groups",
                              .uses = {{"active_blocks", read},
                                       {"active_block_count", read},
                                       {"grid_mass", write},
                                       {"grid_velocity", write},
                                       {"grid_velocity_before", write}}},
              graph::Dispatch{.kernel = "mpm/blocks_mark.comp",
                              .over = "particles",
                              .uses = {{"position", read}, {"order", read}, {"cell_start", read}, {"block_mark", read_write}}},
              graph::Dispatch{.kernel = "mpm/blocks_collect.comp",
                              .over = "grid_blocks",
                              .uses = {{"block_mark", read_write}, {"block_counter", accumulate}, {"active_blocks", write}}},
              graph::Dispatch{.kernel = "mpm/blocks_dispatch.comp",
                              .over = "1",
                              .uses = {{"block_counter", read_write}, {"active_block_count", write}, {"active_groups", write}}},
          }};
}

}  // namespace firn::stages::mpm
