#include "stages/heightfield/resistance.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec resistance() {
  using enum Access;
  const std::vector<graph::PortUse> cells = {
      {"ground", read}, {"depth", read}, {"overlap", read}, {"density", read}, {"owner", read}};
  const auto with = [&](Access peaks, Access counts, std::vector<graph::PortUse> more) {
    more.insert(more.end(), cells.begin(), cells.end());
    more.push_back({"body_peaks", peaks});
    more.push_back({"body_counts", counts});
    return more;
  };
  return {.name = "heightfield.resistance",
          .doc = "What bodies displace, and the force with which it resists their motion",
          .equation = "[H 3.6-3.8]",
          .ports = mpm::joined({ports({"overlap", "density", "owner"}, read),
                                {optional("ground", read), optional("depth", read), mpm::body("body_velocity", read)},
                                {optional("displaced_mass", write), port("contact_point", write), port("resistance", write)},
                                ports({"body_peaks", "body_counts", "body_sums"}, read_write),
                                cell_choice_ports()}),
          .parameters = {cells_parameter(),
                         {.name = "time_constant",
                          .kind = graph::ParameterKind::number,
                          .initial = 1.0,
                          .min = 1.0e-6,
                          .unit = "s",
                          .doc = "time within which a body would give its momentum to the snow it displaces"}},
          .constants = field_constants(),
          .work = sequence({{graph::Dispatch{.kernel = "heightfield/resistance_begin.comp",
                                             .over = "bodies",
                                             .uses = {{"body_peaks", write}, {"body_counts", write}, {"body_sums", write}}}},
                            over_columns("heightfield/resistance_note.comp", with(accumulate, accumulate, {})),
                            over_columns("heightfield/resistance_add.comp", with(read, read, {{"body_sums", accumulate}})),
                            {graph::Dispatch{.kernel = "heightfield/resistance.comp",
                                             .over = "bodies",
                                             .uses = {{"body_peaks", read},
                                                      {"body_counts", read},
                                                      {"body_sums", read},
                                                      {"body_velocity", read},
                                                      {"displaced_mass", write},
                                                      {"contact_point", write},
                                                      {"resistance", write}}}}})};
}

}  // namespace firn::stages::heightfield
