#include "stages/heightfield/support.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec support() {
  using enum Access;
  const std::vector<graph::PortUse> cells = {
      {"ground", read}, {"depth", read}, {"density", read}, {"underside", read}, {"owner", read}};
  const auto with = [&](std::vector<graph::PortUse> uses) {
    uses.insert(uses.end(), cells.begin(), cells.end());
    return uses;
  };
  using enum graph::ParameterKind;
  return {
      .name = "heightfield.support",
      .doc = "What the snow and the ground under each body can bear, before they give way",
      .equation = "strength (rho / rho_max)^exponent h^2 per cell in contact",
      .ports = mpm::joined({ports({"ground", "depth", "density", "underside", "owner"}, read),
                            ports({"support", "support_point"}, write),
                            ports({"support_peaks", "support_counts", "support_sums"}, read_write), cell_choice_ports()}),
      .parameters =
          {{.name = "strength",
            .kind = number,
            .initial = 2.0e4,
            .min = 0.0,
            .unit = "Pa",
            .doc = "pressure that snow at its greatest density bears; 0: only the ground bears"},
           {.name = "exponent",
            .kind = number,
            .initial = 3.0,
            .min = 0.0,
            .max = 10.0,
            .unit = "1",
            .doc = "how steeply that falls with density"},
           {.name = "ground_strength",
            .kind = number,
            .initial = 1.0e7,
            .min = 0.0,
            .unit = "Pa",
            .doc = "pressure that the bare ground bears"},
           {.name = "skin", .kind = number, .initial = 2.0e-3, .min = 0.0, .unit = "m", .doc = "a body this near is in contact"},
           cells_parameter()},
      .constants = field_constants({"max_density"}),
      .work = sequence(
          {{graph::Dispatch{.kernel = "heightfield/support_begin.comp",
                            .over = "bodies",
                            .uses = {{"support_peaks", write}, {"support_counts", write}, {"support_sums", write}}}},
           over_columns("heightfield/support_note.comp", with({{"support_peaks", accumulate}, {"support_counts", accumulate}})),
           over_columns("heightfield/support_add.comp",
                        with({{"support_peaks", read}, {"support_counts", read}, {"support_sums", accumulate}})),
           {graph::Dispatch{.kernel = "heightfield/support.comp",
                            .over = "bodies",
                            .uses = {{"support_peaks", read},
                                     {"support_counts", read},
                                     {"support_sums", read},
                                     {"support", write},
                                     {"support_point", write}}}}})};
}

}  // namespace firn::stages::heightfield
