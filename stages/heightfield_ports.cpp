#include "stages/heightfield_ports.h"

#include <algorithm>
#include <stdexcept>

#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

Port port(const char* name, Access access, Usage usage) {
  struct Facts {
    const char* name;
    ElementType type;
    const char *domain, *unit, *doc;
  };
  using enum ElementType;
  static constexpr Facts table[] = {
      // the field
      {"ground", float1, "cells", "m", "height B of the ground"},
      {"depth", float1, "cells", "m", "depth S of the snow, never negative"},
      {"density", float1, "cells", "kg/m3", "density of the snow; means nothing where there is none"},
      // bodies over it
      {"underside", float1, "cells", "m", "lowest point U of any body over the cell, on its way since the last step; +inf: none"},
      {"owner", int1, "cells", "1", "which body that is; -1: none"},
      {"underside_map", vec2, "cells", "m", "underside and number of the body, as drawn from below"},
      {"underside_depth", ElementType::depth, "cells", "1", "order of the drawn bodies by height"},
      {"overlap", float1, "cells", "m", "how far bodies reach into the snow, D: from 0 to the depth"},
      {"facet_points", vec3, "facets*3", "m", "corners of triangles of boxes and meshes, in the body's own axes"},
      {"facet_body", int1, "facets", "1", "body that a triangle belongs to"},
      {"swept_facets", int1, "swept_facets", "1", "triangles of meshes and of boxes that may turn"},
      // what they do to the snow, and it to them
      {"displaced_mass", float1, "bodies", "kg", "snow that the body displaces"},
      {"contact_point", vec3, "bodies", "m", "mean point of the snow's resistance, 0 where there is none"},
      {"resistance", vec3, "bodies", "N", "force of the displaced snow, against the body's motion"},
      {"support", float1, "bodies", "N", "most that the snow and the ground under the body can bear, upwards"},
      {"support_point", vec3, "bodies", "m", "mean point of that support, 0 where there is none"},
      {"displaced", float1, "cells", "kg/m2", "snow that is pushed away, per area"},
      {"displaced_height", float1, "cells", "m", "the same as depth at the density it had"},
      {"arrived", float1, "cells", "kg/m2", "snow that is pushed here, per area"},
      {"arrived_height", float1, "cells", "m", "the same as depth at the density it had"},
      {"contour_weight", float1, "cells", "1", "factor s of a cell around a body's overlap; 0 elsewhere"},
      {"contour_owner", int1, "cells", "1", "body on whose contour the cell lies; -1: none"},
      {"distance", float1, "cells", "1", "cost of the cheapest way out of the overlap; 0: not in it, +inf: no way"},
      {"moved", float1, "1", "m", "most that a cell gave away in this pass of relaxation"},
      // inner buffers
      {"body_peaks", uint1, "bodies*4", "1", "largest addend of four sums per body, as bits of a float"},
      {"body_counts", uint1, "bodies*4", "1", "number of addends of four sums per body"},
      {"body_sums", uint1, "bodies*8", "1", "four sums per body in two words each"},
      {"push_peaks", uint1, "bodies*4", "1", "largest addend of four sums per body, as bits of a float"},
      {"push_counts", uint1, "bodies*4", "1", "number of addends of four sums per body"},
      {"push_sums", uint1, "bodies*8", "1", "four sums per body in two words each"},
      {"support_peaks", uint1, "bodies*4", "1", "largest addend of four sums per body, as bits of a float"},
      {"support_counts", uint1, "bodies*4", "1", "number of addends of four sums per body"},
      {"support_sums", uint1, "bodies*8", "1", "four sums per body in two words each"},
      {"step_costs", vec4, "bodies*2", "1", "costs of steps: left, right, down, up; then the diagonals between them"},
      {"covered_reach", uint1, "bodies*4", "1", "lowest column and row that the body covers, then the highest"},
      {"leaving", uint1, "cells", "1", "list of cells that hand snow on"},
      {"woken", uint1, "cells", "1", "last turn in which something beside the cell became cheaper"},
      {"waiting", uint1, "cells*2", "1", "two lists of such cells, of this turn and the next"},
      {"waiting_count", uint1, "1", "1", "length of the first of them"},
      {"leaving_count", uint1, "1", "1", "length of that list"},
      {"ways", uint1, "cells", "1",
       "neighbours that the cell hands snow on to, one bit each; from bit 8 those that hand it some; from bit 16 how many of these "
       "have still to do so"},
      {"travelling", vec2, "cells", "kg/m2",
       "snow that passes the cell on its way out, per area, and its depth in m; once it has passed, what each receiver got"},
      {"outflow", vec2, "cells", "m, 1",
       "what a cell gives to each of its receivers in this pass; which neighbours those are, one bit each"},
      {"moved_bits", uint1, "1", "1", "largest outflow of a cell, as bits of a float"},
      {"changed_tiles", uint1, "tiles", "1", "1 where snow or an underside has changed since the last relaxation"},
      {"flatten_count", uint1, "1", "1", "length of the list of tiles for relaxation"},
      {"flatten_tiles", uint1, "tiles", "1", "tiles of 16 x 16 cells that this pass of relaxation works on"},
      {"flatten_groups", uint1, "3", "1", "size of a dispatch with one group per tile of that list"},
      {"tile_stamp", uint1, "tiles", "1", "2 + the last step in which a body was over the tile"},
      {"active_tile_count", uint1, "1", "1", "length of the list of active tiles"},
      {"active_tiles", uint1, "tiles", "1", "tiles of 16 x 16 cells that bodies are over, or were in the last step"},
      {"active_tile_groups", uint1, "3", "1", "size of a dispatch with one group per active tile"},
  };
  // Made as invocations come.
  constexpr std::string_view lists[] = {"leaving", "waiting", "woken", "flatten_tiles", "active_tiles"};
  for (const Facts& facts : table)
    if (std::string_view(name) == facts.name)
      return {.name = facts.name,
              .type = facts.type,
              .domain = facts.domain,
              .access = access,
              .usage = usage,
              .unit = facts.unit,
              .doc = facts.doc,
              .repeatable = std::ranges::find(lists, facts.name) == std::end(lists)};
  throw std::logic_error(std::string("no port of the height field is called ") + name);
}

Port optional(const char* name, Access access) { return mpm::optional(port(name, access)); }
Port optional_body(const char* name, Access access) { return mpm::optional(mpm::body(name, access)); }

std::vector<Port> ports(std::initializer_list<const char*> names, Access access) {
  std::vector<Port> result;
  for (const char* name : names) result.push_back(port(name, access));
  return result;
}

graph::ParameterSpec cells_parameter() {
  return {.name = "cells",
          .kind = graph::ParameterKind::choice,
          .initial = std::string("all"),
          .choices = {"all", "active"},
          .doc = "all cells of the field, or those of the tiles that heightfield.active_tiles found"};
}

std::vector<Port> cell_choice_ports() {
  std::vector<Port> result = {port("active_tiles", Access::read), port("active_tile_groups", Access::read, Usage::indirect)};
  for (Port& p : result) p.when = {"cells", "active"};
  return result;
}

namespace {

std::vector<graph::Work> over_tiles(const std::string& kernel, std::vector<graph::PortUse> uses, int group) {
  std::vector<graph::PortUse> with_tiles = uses;
  with_tiles.push_back({"active_tiles", Access::read});
  return {graph::Dispatch{.kernel = kernel, .over = "cells", .uses = std::move(uses), .when = {"cells", "all"}},
          graph::Dispatch{.kernel = kernel,
                          .over = "",
                          .indirect = "active_tile_groups",
                          .group = group,
                          .uses = std::move(with_tiles),
                          .when = {"cells", "active"}}};
}

}  // namespace

std::vector<graph::Work> over_cells(const std::string& kernel, std::vector<graph::PortUse> uses) {
  return over_tiles(kernel, std::move(uses), tile_edge * tile_edge);
}

std::vector<graph::Work> over_columns(const std::string& kernel, std::vector<graph::PortUse> uses) {
  return over_tiles(kernel, std::move(uses), columns_of_tile);
}

std::vector<graph::ParameterSpec> direction_parameters(double k) {
  return {
      {.name = "direction",
       .kind = graph::ParameterKind::choice,
       .initial = std::string("thesis"),
       .choices = {"thesis", "appendix"},
       .doc = "factor s of a direction w: thesis max(0, v_xz/|v_xz| . w) + r/k [H 3.19]; appendix d max(0, v_xz . w) + r/k, the "
              "rule behind the thesis's printed tables"},
      {.name = "k",
       .kind = graph::ParameterKind::number,
       .initial = k,
       .min = 1.0,
       .unit = "1",
       .doc = "how little a body that goes straight down pushes to the sides"}};
}

std::vector<std::string> field_constants(std::initializer_list<const char*> more) {
  std::vector<std::string> names = {"field_min", "field_cell"};
  names.insert(names.end(), more.begin(), more.end());
  return names;
}

std::vector<graph::Work> sequence(std::initializer_list<std::vector<graph::Work>> lists) {
  std::vector<graph::Work> all;
  for (const std::vector<graph::Work>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace firn::stages::heightfield
