#include "stages/heightfield/overlap.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec overlap() {
  using enum Access;
  return {
      .name = "heightfield.overlap",
      .doc = "How far bodies reach into the snow",
      .equation = "[H 3.2, 3.4]",
      .ports = mpm::joined({ports({"ground", "depth", "underside"}, read), {port("overlap", write)}, cell_choice_ports()}),
      .parameters = {cells_parameter()},
      .work = over_cells("heightfield/overlap.comp", {{"ground", read}, {"depth", read}, {"underside", read}, {"overlap", write}})};
}

}  // namespace firn::stages::heightfield
