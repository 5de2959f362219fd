#pragma once

// From the command line of `try` to a plan of one stage and the contents of its buffers.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/named_files.h"
#include "graph/plan.h"
#include "graph/registry.h"

namespace firn::app {

struct TryOptions {
  std::string stage, scene, device = "auto";
  std::vector<std::string> in, out, set, constants, sizes;
  std::optional<double> dt;
  double time = 0;
  std::int64_t repeat = 1;
  bool json = false;
};

struct Trial {
  graph::Registry registry;
  graph::Plan plan;                                        // one stage, in its step
  std::map<std::string, std::vector<std::byte>> contents;  // by buffer, packed
  std::vector<NamedFile> outputs;
  double dt = 0;
  std::vector<std::string> notes;   // what was taken for what nobody gave
  config::Diagnostics diagnostics;  // warnings
};

// Throws config::InputError with everything that is wrong.
Trial prepare_trial(const TryOptions& options);

}  // namespace firn::app
