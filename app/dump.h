#pragma once

// Buffers that a run writes to .npy files at its end (shapes: app/arrays.h).

#include <filesystem>
#include <string>
#include <vector>

#include "app/named_files.h"
#include "graph/plan.h"

namespace firn::app {

// Names must be buffers of the plan, and folders must be there; `output` will be.
void check_dumps(const std::vector<NamedFile>& dumps, const graph::Plan& plan, const std::filesystem::path& output,
                 config::Diagnostics& diagnostics);

}  // namespace firn::app
