#include "stages/heightfield/contour.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec contour() {
  using enum Access;
  std::vector<graph::ParameterSpec> parameters = direction_parameters(8.0);
  parameters.push_back(cells_parameter());
  return {.name = "heightfield.contour",
          .doc = "The cells around each body's overlap, and how strongly the body pushes snow there",
          .equation = "[H 3.12-3.24]",
          .ports = mpm::joined({ports({"overlap", "owner"}, read),
                                {mpm::body("body_velocity", read)},
                                ports({"contour_weight", "contour_owner"}, write),
                                cell_choice_ports()}),
          .parameters = parameters,
          .work = over_cells("heightfield/contour.comp", {{"overlap", read, graph::Usage::sampled},
                                                          {"owner", read, graph::Usage::sampled},
                                                          {"body_velocity", read},
                                                          {"contour_weight", write},
                                                          {"contour_owner", write}})};
}

}  // namespace firn::stages::heightfield
