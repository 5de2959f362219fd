#pragma once

// What a run was asked for, kept in its manifest and in its checkpoints so that it can go on and be repeated.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/load.h"

namespace firn::app {

inline constexpr std::size_t default_keep = 3;

struct RunOptions {
  Inputs inputs;
  std::string output, device = "auto", barriers = "derived";
  std::optional<std::uint64_t> steps, frames;
  std::vector<std::string> dumps;               // BUFFER=FILE.npy
  std::uint64_t checkpoint_every = 0;           // steps; 0: none but when interrupted
  std::optional<std::size_t> keep_checkpoints;  // the newest; none given: 3; 0: no checkpoints at all
  bool force = false;
  std::optional<std::string> resume;  // folder; empty: the run's own
  std::string from;                   // manifest of a run to repeat
};

// Everything that decides what the run does. File names as they were given, with the folder they start from.
nlohmann::json to_json(const RunOptions& options);

// The reverse, with files found from where the run was started, if they are not here. Throws config::InputError where `json`, read
// from `file`, is not of that kind.
RunOptions options_from(const nlohmann::json& json, const std::string& file);

}  // namespace firn::app
