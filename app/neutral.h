#pragma once

// What stands for a port of a stage that is tried alone, where nothing was given for it.

#include <optional>
#include <string>
#include <vector>

#include "graph/spec.h"

namespace firn::app {

struct Neutral {
  std::vector<double> element;  // one value per component; a single one counts for all
  std::string meaning;          // "no body is over any cell"; empty: as buffers are when a run starts
};

// Nothing where no value would be neutral: the stage has nothing to do without it.
std::optional<Neutral> neutral_value(const graph::Port& port);

}  // namespace firn::app
