#include "stages/heightfield/distance_transform.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec distance_transform() {
  using enum Access;
  std::vector<graph::ParameterSpec> parameters = direction_parameters(4.0);
  parameters.push_back(cells_parameter());
  return {
      .name = "heightfield.distance_transform",
      .doc = "What the cheapest way out from under a body costs, where a step costs the more the less the body pushes that way",
      .equation = "[H 3.8, 3.12-3.19]",
      .ports = mpm::joined({ports({"overlap", "owner"}, read),
                            {mpm::body("body_velocity", read), port("distance", read_write)},
                            ports({"step_costs", "covered_reach", "woken", "waiting", "waiting_count"}, read_write),
                            cell_choice_ports()}),
      .parameters = parameters,
      .work = sequence(
          {{graph::Dispatch{.kernel = "heightfield/distance_costs.comp",
                            .over = "bodies",
                            .uses = {{"body_velocity", read}, {"step_costs", write}, {"covered_reach", write}}}},
           over_cells("heightfield/distance_begin.comp",
                      {{"overlap", read}, {"owner", read}, {"distance", write}, {"woken", write}, {"covered_reach", accumulate}}),
           {graph::Dispatch{.kernel = "heightfield/distance_sweep.comp",
                            .over = "bodies*32",
                            .group = 32,
                            .uses = {{"owner", read}, {"step_costs", read}, {"covered_reach", read}, {"distance", read_write}}}},
           over_cells(
               "heightfield/distance_check.comp",
               {{"owner", read}, {"step_costs", read}, {"distance", read}, {"waiting", write}, {"waiting_count", accumulate}}),
           {graph::Dispatch{.kernel = "heightfield/distance_transform.comp",
                            .over = "64",
                            .group = 64,
                            .uses = {{"owner", read},
                                     {"step_costs", read},
                                     {"distance", read_write},
                                     {"woken", read_write},
                                     {"waiting", read_write},
                                     {"waiting_count", read_write}}}}})};
}

}  // namespace firn::stages::heightfield
