#pragma once

// What a device can do at most, measured: the yardstick for passes.

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "gpu/device.h"

namespace firn::app {

struct Speed {
  double copy = 0;          // bytes/s, read and written ones together, by a kernel that copies 16 bytes an invocation
  double buffer_copy = 0;   // the same by glCopyBufferSubData
  double multiply_add = 0;  // operations/s, a multiplication and an addition each counted, of 32-bit floats
  double launch = 0;        // s from one dispatch of an empty kernel to the next

  [[nodiscard]] double bandwidth() const { return std::max(copy, buffer_copy); }  // bytes/s
};

// Medians of several measurements; takes about a second on a software renderer. Throws gpu::DeviceError and gpu::ShaderError.
Speed measure_speed(gpu::Device& device);

nlohmann::json as_json(const Speed& speed);
// "41.2 GB/s", "3.35 TB/s"; "12.1 GFLOP/s"
std::string in_words(double per_second, const std::string& unit);

}  // namespace firn::app
