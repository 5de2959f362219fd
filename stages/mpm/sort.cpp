#include "stages/mpm/sort.h"

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {

// Particles stay where they are in memory; only their numbers are sorted. Six kernels, each over particles or rows of cells.
graph::StageSpec sort() {
  const auto own = [](const char* name, const char* domain, const char* doc) {
    return Port{.name = name, .type = ElementType::uint1, .domain = domain, .access = Access::read_write, .unit = "1", .doc = doc};
  };
  using enum Access;
  return {
      .name = "mpm.sort",
      .doc = "Sorts particles by the grid cell they lie in (counting sort), within one cell by number",
      .equation = "",
      .ports = {position(read), order(write), cell_start(read_write), own("cell_count", "nodes", "particles of every cell"),
                own("row_count", "grid_rows", "particles of every row of cells"),
                own("row_start", "grid_rows", "place of every row's first particle"),
                own("row_filled", "grid_rows", "whether cell_start of the row was written for particles"),
                own("particle_cell", "particles", "cell of every particle"),
                own("particle_rank", "particles", "place of every particle in its cell, unordered"),
                own("unordered", "particles", "numbers of particles, sorted by cell only")},
      .constants = {"grid_min", "grid_cell", "grid_nodes"},
      .work = {
          graph::Dispatch{.kernel = "mpm/sort_begin.comp", .over = "grid_rows", .uses = {{"row_count", write}}},
          graph::Dispatch{.kernel = "mpm/sort_count.comp",
                          .over = "particles",
                          .uses = {{"position", read},
                                   {"particle_cell", write},
                                   {"particle_rank", write},
                                   {"cell_count", accumulate},
                                   {"row_count", accumulate}}},
          graph::Dispatch{
              .kernel = "mpm/sort_scan_rows.comp", .over = "1", .group = 256, .uses = {{"row_count", read}, {"row_start", write}}},
          graph::Dispatch{.kernel = "mpm/sort_scan_cells.comp",
                          .over = "grid_rows",
                          .uses = {{"row_count", read},
                                   {"row_start", read},
                                   {"row_filled", read_write},
                                   {"cell_count", read_write},
                                   {"cell_start", write}}},
          graph::Dispatch{.kernel = "mpm/sort_scatter.comp",
                          .over = "particles",
                          .uses = {{"cell_start", read}, {"particle_cell", read}, {"particle_rank", read}, {"unordered", write}}},
          graph::Dispatch{.kernel = "mpm/sort_order.comp",
                          .over = "particles",
                          .uses = {{"cell_start", read}, {"particle_cell", read}, {"unordered", read}, {"order", write}}},
      }};
}

}  // namespace firn::stages::mpm
