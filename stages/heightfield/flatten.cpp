#include "stages/heightfield/flatten.h"

#include <string_view>

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec flatten() {
  using enum Access;
  const auto passes = [](const char* kernel, const std::vector<graph::PortUse>& uses) {
    std::vector<graph::PortUse> with_tiles = uses;
    with_tiles.push_back({"flatten_tiles", read});
    if (std::string_view(kernel) == "heightfield/flatten.comp") with_tiles.push_back({"changed_tiles", read_write});
    return std::vector<graph::Work>{graph::Dispatch{.kernel = kernel, .over = "cells", .uses = uses, .when = {"cells", "all"}},
                                    graph::Dispatch{.kernel = kernel,
                                                    .over = "",
                                                    .indirect = "flatten_groups",
                                                    .group = columns_of_tile,
                                                    .uses = with_tiles,
                                                    .when = {"cells", "active"}}};
  };
  const auto active = [](Port port) {
    port.when = {"cells", "active"};
    return port;
  };
  using enum graph::ParameterKind;
  return {
      .name = "heightfield.flatten",
      .doc = "One pass of relaxation: snow slides off where a slope is too steep, unless a body is in the way",
      .equation = "[H 3.29-3.33]",
      .ports = mpm::joined({ports({"ground", "underside"}, read),
                            ports({"depth", "density"}, read_write),
                            {port("moved", write)},
                            ports({"outflow", "moved_bits"}, read_write),
                            {active(port("changed_tiles", read_write)), active(port("flatten_tiles", read_write)),
                             active(port("flatten_count", read_write)), active(port("flatten_groups", read_write))}}),
      .parameters = {{.name = "slope",
                      .kind = number,
                      .initial = 0.0,
                      .min = 0.0,
                      .unit = "m/m",
                      .doc = "steepest slope that stands; 0: that of the field's material"},
                     {.name = "diagonal",
                      .kind = choice,
                      .initial = std::string("euclidean"),
                      .choices = {"euclidean", "thesis"},
                      .doc = "distance of diagonal neighbours: that of their centres, or of the others"},
                     {.name = "relaxation",
                      .kind = number,
                      .initial = 1.0,
                      .min = 0.0,
                      .max = 1.5,
                      .unit = "1",
                      .doc = "share of the mean excess that a cell gives away in one pass; 1.5 swings"},
                     {.name = "tie",
                      .kind = number,
                      .initial = 1.0e-6,
                      .min = 0.0,
                      .unit = "m",
                      .doc = "heights that differ by no more count as equal"},
                     {.name = "quiet",
                      .kind = number,
                      .initial = 0.0,
                      .min = 0.0,
                      .unit = "1",
                      .doc = "cells that would give no more than this share of their edge give nothing, and let their tile rest"},
                     {.name = "cells",
                      .kind = choice,
                      .initial = std::string("all"),
                      .choices = {"all", "active"},
                      .doc = "all cells of the field, or those of tiles near which something changed since the last pass"}},
      .constants = {"field_cell", "material_slope"},
      .work = sequence(
          {{graph::Dispatch{.kernel = "heightfield/flatten_begin.comp",
                            .over = "1",
                            .uses = {{"moved", write}, {"moved_bits", write}},
                            .when = {"cells", "all"}},
            graph::Dispatch{.kernel = "heightfield/flatten_list.comp",
                            .over = "tiles",
                            .uses = {{"changed_tiles", read_write}, {"flatten_tiles", write}, {"flatten_count", accumulate}},
                            .when = {"cells", "active"}},
            graph::Dispatch{.kernel = "heightfield/flatten_tiles.comp",
                            .over = "64",
                            .group = 64,
                            .uses = {{"moved", write},
                                     {"moved_bits", write},
                                     {"changed_tiles", read_write},
                                     {"flatten_tiles", read_write},
                                     {"flatten_count", read_write},
                                     {"flatten_groups", write}},
                            .when = {"cells", "active"}}},
           passes("heightfield/flatten_outflow.comp", {{"ground", read, graph::Usage::sampled},
                                                       {"underside", read, graph::Usage::sampled},
                                                       {"depth", read, graph::Usage::sampled},
                                                       {"outflow", write},
                                                       {"moved_bits", accumulate}}),
           passes("heightfield/flatten.comp", {{"outflow", read, graph::Usage::sampled},
                                               {"depth", read_write},
                                               {"density", read_write},
                                               {"moved_bits", read},
                                               {"moved", write}})})};
}

}  // namespace firn::stages::heightfield
