#include "stages/heightfield/distribute_contour.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec distribute_contour() {
  using enum Access;
  const auto addends = [&](std::vector<graph::PortUse> more) {
    for (const char* name : {"contour_weight", "contour_owner", "displaced", "displaced_height", "owner"})
      more.push_back({name, read});
    return more;
  };
  return {.name = "heightfield.distribute_contour",
          .doc = "Lays what each body displaces on the cells around it, by their weights",
          .equation = "[H 3.25-3.28]",
          .ports = mpm::joined({ports({"contour_weight", "contour_owner", "displaced", "owner"}, read),
                                {optional("displaced_height", read), port("arrived", write), optional("arrived_height", write)},
                                ports({"push_peaks", "push_counts", "push_sums"}, read_write),
                                cell_choice_ports()}),
          .parameters = {cells_parameter()},
          .work = sequence(
              {{graph::Dispatch{.kernel = "heightfield/push_begin.comp",
                                .over = "bodies",
                                .uses = {{"push_peaks", write}, {"push_counts", write}, {"push_sums", write}}}},
               over_columns("heightfield/push_note.comp", addends({{"push_peaks", accumulate}, {"push_counts", accumulate}})),
               over_columns("heightfield/push_add.comp",
                            addends({{"push_peaks", read}, {"push_counts", read}, {"push_sums", accumulate}})),
               over_cells("heightfield/distribute_contour.comp", addends({{"push_peaks", read},
                                                                          {"push_counts", read},
                                                                          {"push_sums", read},
                                                                          {"arrived", write},
                                                                          {"arrived_height", write}}))})};
}

}  // namespace firn::stages::heightfield
