#pragma once

// A stage without C++: one compute shader whose first comment is its spec, in YAML (docs/pipelines.md has the format).

#include <filesystem>
#include <optional>
#include <string>

#include "config/diagnostics.h"
#include "graph/spec.h"

namespace firn::graph {

// Whether a stage in a pipeline is named by its file: "./blur.comp".
bool is_stage_file(const std::string& name);

// The spec at the head of a shader, with one dispatch of that shader. Nothing where anything is wrong with it; errors have their
// place inside the file.
std::optional<StageSpec> read_stage_file(const std::filesystem::path& file, config::Diagnostics& diagnostics);

}  // namespace firn::graph
