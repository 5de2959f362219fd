#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/diagnostics.h"

namespace firn::graph {

// Domains and constants that a scene has no values for (Environment::missing): one error for each reason, however many stages need
// something of it.
class Lacking {
 public:
  // `text`: the error where nothing else is missing for that reason.
  void note(const std::string& reason, const config::Place& place, const std::string& stage, const std::string& name,
            const std::string& text);
  void tell(config::Diagnostics& diagnostics) const;

 private:
  struct Needs {
    config::Place first;
    std::vector<std::string> stages, names;  // each once
    std::string only;
  };
  std::map<std::string, Needs> by_reason_;
};

}  // namespace firn::graph
