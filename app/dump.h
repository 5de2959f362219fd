#pragma once

// Buffers as .npy files.

#include <string>
#include <vector>

#include "graph/execution/execution.h"

namespace firn::app {

struct Dump {
  std::string buffer, file;
};

// Reads "BUFFER=FILE.npy" words. Throws config::InputError for malformed ones and for buffers the plan does not have.
std::vector<Dump> parse_dumps(const std::vector<std::string>& words, const graph::Plan& plan);

// Shape: that of the domain (particles: N; nodes: nz, ny, nx), then the components (vec3: 3; mat3: 3, 3), without padding.
void write_dump(const execution::Execution& execution, const Dump& dump);

}  // namespace firn::app
