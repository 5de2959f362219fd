#pragma once

#include <string>
#include <vector>

#include "graph/spec.h"

namespace firn::graph {

// One of problems() with what it speaks of, for those who know where that was written.
struct Problem {
  std::string part;               // "port velocity", "parameter rate", "constant gravity"; empty: the stage itself
  std::vector<std::string> keys;  // of the part, any of which may be the wrong one: "type", "usage"; none: its name
  std::string text;
};
std::vector<Problem> find_problems(const StageSpec& spec);

}  // namespace firn::graph
