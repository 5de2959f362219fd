#pragma once

// Checkpoints: the whole state of a run between two steps, in folders OUT/checkpoints/step_NNNNNNNN (docs/runs.md has the format).
// A checkpoint is written beside its place and renamed, so that one with its name is whole.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "graph/execution/execution.h"

namespace firn::app {

// `about`: what the manifest says besides the state itself: {"identity", "inputs", ...}. The newest `keep` stay, older ones go.
// Everything that stages write is in files first. Throws std::runtime_error where that cannot be written, NumbersError where the
// numbers broke: such a state is not kept.
std::filesystem::path write_checkpoint(const std::filesystem::path& run, execution::Execution& execution, nlohmann::json about,
                                       std::size_t keep);

std::string checkpoint_name(std::uint64_t step);  // "step_00000100"

// Those of a run, oldest first.
std::vector<std::filesystem::path> checkpoints_of(const std::filesystem::path& run);

struct Checkpoint {
  std::filesystem::path folder;
  nlohmann::json manifest;
  graph::Clock clock;
};

// The checkpoint of a folder, or the newest of a run's folder, with every hash compared. Throws config::InputError with a sentence
// that names the file at fault, and the checkpoint before it that is whole.
Checkpoint read_checkpoint(const std::filesystem::path& folder);
// The run's folder that a checkpoint lies in.
std::filesystem::path run_of(const Checkpoint& checkpoint);

// Those of the run that are newer go, as it goes this way again; of the others, the newest `keep` stay.
void go_back_to(const Checkpoint& checkpoint, std::size_t keep);

// Fills the buffers and sets the clock. Throws config::InputError where an array is not what the plan calls for. Returns the
// buffers of the plan that the checkpoint has nothing for: every step makes them anew.
std::vector<std::string> restore(const Checkpoint& checkpoint, execution::Execution& execution);

}  // namespace firn::app
