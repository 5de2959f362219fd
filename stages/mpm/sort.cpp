#include "stages/mpm/sort.h"

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {
namespace {

using enum Access;
using graph::Dispatch;
using graph::PortUse;
using graph::Work;

Port own(const char* name, const char* domain, const char* doc) {
  return unrepeatable({.name = name, .type = ElementType::uint1, .domain = domain, .access = read_write, .unit = "1", .doc = doc});
}

std::vector<Port> only(const char* nodes, std::vector<Port> ports) {
  for (Port& port : ports) port = when(port, "nodes", nodes);
  return ports;
}

// Cells of the whole grid, in rows.
std::vector<Port> all_ports() {
  return only("all", {cell_start(read_write), own("cell_count", "nodes", "particles of every cell"),
                      own("row_count", "grid_rows", "particles of every row of cells"),
                      own("row_start", "grid_rows", "place of every row's first particle"),
                      own("row_filled", "grid_rows", "whether cell_start of the row was written for particles")});
}
std::vector<Work> over_all() {
  const graph::Condition all{"nodes", "all"};
  return {
      Dispatch{.kernel = "mpm/sort_begin.comp", .over = "grid_rows", .uses = {{"row_count", write}}, .when = all},
      Dispatch{.kernel = "mpm/sort_count.comp",
               .over = "particles",
               .uses = {{"position", read},
                        {"particle_cell", write},
                        {"particle_rank", write},
                        {"cell_count", accumulate},
                        {"row_count", accumulate}},
               .when = all},
      Dispatch{.kernel = "mpm/sort_scan_rows.comp",
               .over = "1",
               .group = 256,
               .uses = {{"row_count", read}, {"row_start", write}},
               .when = all},
      Dispatch{.kernel = "mpm/sort_scan_cells.comp",
               .over = "grid_rows",
               .uses = {{"row_count", read},
                        {"row_start", read},
                        {"row_filled", read_write},
                        {"cell_count", read_write},
                        {"cell_start", write}},
               .when = all},
      Dispatch{.kernel = "mpm/sort_scatter.comp",
               .over = "particles",
               .uses = {{"cell_start", read}, {"particle_cell", read}, {"particle_rank", read}, {"unordered", write}},
               .when = all},
      Dispatch{.kernel = "mpm/sort_order.comp",
               .over = "particles",
               .uses = {{"cell_start", read}, {"particle_cell", read}, {"unordered", read}, {"order", write}},
               .when = all},
  };
}

// Cells of blocks that a hash table finds: nothing here is as large as the grid. The order of blocks differs from run to run; sums
// over particles do not follow it, so results repeat to the bit all the same.
std::vector<Port> active_ports() {
  return only("active",
              {active_blocks(read_write), active_block_count(read_write), active_groups(write), block_slot(read_write),
               block_near(write), block_cells(read_write), block_entry(read_write),
               own("block_groups", "3", "size of a dispatch with one invocation per block, groups of 64"),
               own("block_key", "block_table", "number of the block + 1, and the highest bit where particles lie in it; 0: free"),
               own("block_counter", "1", "blocks found so far"), own("particle_counter", "1", "particles placed so far"),
               own("cell_count", "block_table*64", "particles of every cell")});
}
std::vector<Work> over_active() {
  const graph::Condition active{"nodes", "active"};
  const auto over_blocks = [&](const char* kernel, std::vector<PortUse> uses) {
    return Dispatch{.kernel = kernel, .over = "", .indirect = "block_groups", .uses = std::move(uses), .when = active};
  };
  return {
      over_blocks("mpm/blocks_begin.comp", {{"active_block_count", read}, {"block_entry", read}, {"block_key", write}}),
      Dispatch{.kernel = "mpm/blocks_find.comp",
               .over = "particles",
               .uses = {{"position", read, Usage::sampled},
                        {"block_key", read_write},
                        {"block_slot", write},
                        {"block_counter", accumulate},
                        {"active_blocks", write},
                        {"block_entry", write},
                        {"cell_count", accumulate},
                        {"particle_cell", write},
                        {"particle_rank", write}},
               .when = active},
      Dispatch{.kernel = "mpm/blocks_count.comp",
               .over = "1",
               .uses = {{"block_counter", read_write},
                        {"particle_counter", read_write},
                        {"active_block_count", write},
                        {"active_groups", write},
                        {"block_groups", write}},
               .when = active},
      over_blocks("mpm/blocks_scan.comp", {{"active_block_count", read},
                                           {"active_blocks", read},
                                           {"block_entry", read},
                                           {"block_key", read},
                                           {"block_slot", read},
                                           {"cell_count", read_write},
                                           {"particle_counter", accumulate},
                                           {"block_cells", write},
                                           {"block_near", write}}),
      Dispatch{.kernel = "mpm/blocks_scatter.comp",
               .over = "particles",
               .uses = {{"block_cells", read}, {"particle_cell", read}, {"particle_rank", read}, {"unordered", write}},
               .when = active},
      Dispatch{.kernel = "mpm/blocks_order.comp",
               .over = "particles",
               .uses = {{"block_cells", read}, {"particle_cell", read}, {"unordered", read}, {"order", write}},
               .when = active},
  };
}

}  // namespace

// Particles stay where they are in memory; only their numbers are sorted.
graph::StageSpec sort() {
  std::vector<Work> work = over_all();
  for (Work& one : over_active()) work.push_back(std::move(one));
  return {.name = "mpm.sort",
          .doc =
              "Sorts particles by the grid cell they lie in (counting sort), within one cell by number; with `nodes: active` "
              "finds and stores the blocks of 4 x 4 x 4 nodes that they reach (room for them: `blocks` of the scene's domain)",
          .equation = "",
          .ports = joined({{position(read), order(write), particle_cell(read_write),
                            own("particle_rank", "particles", "place of every particle in its cell, unordered"),
                            own("unordered", "particles", "numbers of particles, sorted by cell only")},
                           all_ports(),
                           active_ports()}),
          .parameters = {nodes_parameter()},
          .constants = {"grid_min", "grid_cell", "grid_nodes"},
          .faults = {graph::Fault::overflow},
          .work = std::move(work)};
}

}  // namespace firn::stages::mpm
