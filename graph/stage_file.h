#pragma once

// A stage without C++: one compute shader whose first comment is its spec, in YAML (docs/pipelines.md has the format).

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/diagnostics.h"
#include "graph/spec.h"

namespace firn::graph {

// Whether a stage in a pipeline is named by its file: "./blur.comp".
bool is_stage_file(const std::string& name);

// The spec at the head of a shader, with one dispatch of that shader. Nothing where anything is wrong with it: every mistake is
// told, at its place inside the file.
std::optional<StageSpec> read_stage_file(const std::filesystem::path& file, config::Diagnostics& diagnostics);

// Where the head of a stage's file, which is read again, names a domain or a constant.
std::vector<config::Place> places_in_head(const StageSpec& spec, const std::string& name);

}  // namespace firn::graph
