#include "app/neutral.h"

#include <algorithm>
#include <limits>
#include <string_view>

namespace firn::app {

std::optional<Neutral> neutral_value(const graph::Port& port) {
  // What a stage is about cannot be made up.
  constexpr std::string_view always_needed[] = {"position",         "mass",      "volume",    "depth",        "material_elastic",
                                                "material_plastic", "body_kind", "body_size", "body_position"};
  // Lists that another stage makes; the stage that keeps them starts from none.
  constexpr std::string_view made_elsewhere[] = {
      "order",      "cell_start",  "active_blocks", "active_block_count", "active_groups",      "block_groups",    "block_slot",
      "block_near", "block_cells", "particle_cell", "active_tiles",       "active_tile_groups", "packed_particles"};
  if (std::ranges::find(always_needed, port.name) != std::end(always_needed)) return std::nullopt;
  if (port.access == graph::Access::read && std::ranges::find(made_elsewhere, port.name) != std::end(made_elsewhere))
    return std::nullopt;
  struct Row {
    std::string_view name;
    Neutral value;
  };
  const Row table[] = {
      {"underside", {{std::numeric_limits<double>::infinity()}, "no body is over any cell"}},
      {"owner", {{-1}, "no body is over any cell"}},
      {"contour_owner", {{-1}, "no cell lies on a contour"}},
      {"overlap", {{0}, "no body reaches into the snow"}},
      {"density", {{100}, "fresh snow, kg/m3"}},
      {"body_orientation", {{0, 0, 0, 1}, "not turned"}},
      {"body_orientation_before", {{0, 0, 0, 1}, "not turned"}},
      {"path_orientation", {{0, 0, 0, 1}, "not turned"}},
      {"elastic", {{1, 0, 0, 0, 1, 0, 0, 0, 1}, "not deformed"}},
      {"plastic_det", {{1}, "not deformed"}},
      {"body_mass", {{0}, "moves as told"}},
  };
  for (const Row& row : table)
    if (row.name == port.name) return row.value;
  return Neutral{{0}, ""};
}

}  // namespace firn::app
