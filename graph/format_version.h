#pragma once

#include <string_view>

#include "config/reader.h"

namespace firn::graph {

// The key that the file of `what` ("a pipeline") begins with; there is one version so far.
void read_version(config::Reader& reader, std::string_view what);

}  // namespace firn::graph
