#include "stages/heightfield/distribute_distance.h"

#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::heightfield {

graph::StageSpec distribute_distance() {
  using enum Access;
  return {
      .name = "heightfield.distribute_distance",
      .doc = "Sends what bodies displace down the distances until it is out from under them",
      .equation = "[H 3.8]",
      .ports = mpm::joined({ports({"distance", "displaced"}, read),
                            {optional("displaced_height", read), port("arrived", write), optional("arrived_height", write)},
                            ports({"ways", "travelling", "leaving", "leaving_count"}, read_write),
                            cell_choice_ports()}),
      .parameters = {{.name = "neighbours",
                      .kind = graph::ParameterKind::choice,
                      .initial = std::string("8"),
                      .choices = {"4", "8"},
                      .doc = "to which of its neighbours a cell may hand snow on: 4 share an edge with it, 8 also a corner"},
                     cells_parameter()},
      .work = sequence(
          {over_cells("heightfield/travel_begin.comp", {{"distance", read},
                                                        {"displaced", read},
                                                        {"displaced_height", read},
                                                        {"ways", write},
                                                        {"travelling", write},
                                                        {"leaving", write},
                                                        {"leaving_count", accumulate}}),
           {graph::Dispatch{
               .kernel = "heightfield/travel.comp",
               .over = "32",
               .group = 32,
               .uses = {{"ways", read_write}, {"travelling", read_write}, {"leaving", read_write}, {"leaving_count", read_write}}}},
           over_cells("heightfield/distribute_distance.comp",
                      {{"distance", read}, {"ways", read}, {"travelling", read}, {"arrived", write}, {"arrived_height", write}})})};
}

}  // namespace firn::stages::heightfield
