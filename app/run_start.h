#pragma once

// What a run starts from: the command line alone, a checkpoint, or the manifest of a run to be repeated.

#include <filesystem>
#include <optional>

#include "app/checkpoint.h"
#include "app/run_folder.h"
#include "app/run_options.h"

namespace firn::app {

struct RunStart {
  RunOptions options;  // as they are to be followed
  std::filesystem::path output;
  Claim claim = Claim::fresh;
  std::optional<Checkpoint> checkpoint;
  nlohmann::json repeated;  // manifest of the run to repeat; null: none
};

// Throws config::InputError where there is nothing to go on from or to repeat.
RunStart run_start(RunOptions given);

}  // namespace firn::app
