#pragma once

// Every stage a pipeline may use.

#include <map>
#include <string>
#include <vector>

#include "graph/host.h"
#include "graph/spec.h"

namespace firn::graph {

struct StageType {
  StageSpec spec;
  HostFactory host = {};  // needed where the spec has HostWork
};

class Registry {
 public:
  // Throws std::logic_error for a spec with problems() or a name taken twice: our own mistake, found at start.
  void add(StageSpec spec, HostFactory host = {});

  [[nodiscard]] const StageType* find(const std::string& name) const;
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] const std::map<std::string, StageType>& all() const { return stages_; }

 private:
  std::map<std::string, StageType> stages_;
};

}  // namespace firn::graph
