#pragma once

// manifest.json: what was run, so that it can be run again, and what came of it.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/load.h"
#include "app/named_files.h"
#include "app/run_options.h"
#include "gpu/device.h"

namespace firn::app {

struct RunFacts {
  std::vector<std::string> command;       // the words of the command line
  std::string started;                    // UTC, ISO 8601
  std::vector<std::string> resumed_from;  // checkpoints, oldest first
  double seconds = 0;                     // of this process
  std::uint64_t steps = 0, frames = 0;
  double time = 0;                 // s, simulated
  std::optional<int> exit_status;  // none: running, or it died
  std::string message;             // why it ended early; empty: it did not
  nlohmann::json outputs = nlohmann::json::object();
};

nlohmann::json manifest(const Loaded& loaded, const nlohmann::json& identity, const gpu::DeviceInfo& device,
                        const RunOptions& options, const RunFacts& facts);

// The identity (identity.h) of a run, out of its manifest.
nlohmann::json identity_in(const nlohmann::json& manifest);

// Program and revision, as manifests and checkpoints have them.
nlohmann::json program_json();

// Written beside and renamed, so that there is never half of it. Throws std::runtime_error naming the file.
void write_manifest(const std::filesystem::path& file, const nlohmann::json& manifest);

// Hashes of what a run has left in its folder, by file: pictures, film, metrics (without what the clock on the wall says), exports;
// and of `dumps`, by "dump BUFFER".
nlohmann::json hashes_of_outputs(const std::filesystem::path& run, const std::vector<NamedFile>& dumps);

}  // namespace firn::app
