#pragma once

// manifest.json: what was run, so that it can be run again.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/load.h"
#include "gpu/device.h"

namespace firn::app {

struct RunFacts {
  std::vector<std::string> command;  // the words of the command line
  std::string started;               // UTC, ISO 8601
  double seconds = 0;
  std::uint64_t steps = 0, frames = 0;
  double time = 0;  // s, simulated
  int exit_status = 0;
  std::string message;  // why it ended early; empty: it did not
};

nlohmann::json manifest(const Loaded& loaded, const gpu::DeviceInfo& device, const RunFacts& facts);

// Written beside and renamed, so that there is never half of it. Throws std::runtime_error naming the file.
void write_manifest(const std::string& file, const nlohmann::json& manifest);

}  // namespace firn::app
