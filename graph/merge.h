#pragma once

// A pipeline file as one tree: with what it includes, and its groups' stages replaced.

#include <filesystem>
#include <string>

#include "config/node.h"

namespace firn::graph {

inline constexpr const char* phase_names[] = {"setup", "step", "frame"};

// `path` as one that is relative to the file of `place`; on the command line, to the current folder.
std::string beside(const config::Place& place, const std::string& path);

// Gives `stages` to every group of that name. No such group is an error at `place`.
void replace_group(config::Node& root, const std::string& group, const config::Node& stages, const config::Place& place,
                   config::Diagnostics& diagnostics);

// The file with what it includes: its own keys win, `parameters` are merged, `replace` swaps the stages of groups.
config::Node load_merged(const std::filesystem::path& file, config::Diagnostics& diagnostics);

}  // namespace firn::graph
