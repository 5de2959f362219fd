#pragma once

// Stages that have one computation written for several kinds of devices let the pipeline choose among these forms. What it leaves
// to `auto` is decided here, once for a device, and put into the environment's choices under the parameter's name.

#include <cstdint>
#include <map>
#include <string>

#include "graph/environment.h"

namespace firn::stages {

// What of a device decides.
struct DeviceProfile {
  std::string name = "a software renderer";
  bool assumed = true;  // no device has been asked
  bool software = true;
  int subgroup_size = 0;  // invocations; 0: none in compute shaders
  std::uint64_t storage_block_bytes = std::uint64_t{128} << 20;
};
// Hardware that is not there to be asked.
DeviceProfile assumed_hardware(bool subgroups);

struct Forms {
  std::map<std::string, std::string> choices;  // "form", "nodes"
  std::string reason;
};
// Of an environment without a grid, or whose grid has blocks.
Forms forms_for(const DeviceProfile& device, const graph::Environment& environment);

}  // namespace firn::stages
