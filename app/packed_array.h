#pragma once

// One buffer of a plan as a .npy.zst file: NumPy's array file, compressed by Zstandard.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "graph/plan.h"

namespace firn::app {

struct PackedArray {
  std::string file;              // the whole content of the file
  std::uint64_t no_numbers = 0;  // how many of its values are NaN
};

// `contents`: as the buffer lies on the device.
PackedArray pack(const graph::Plan& plan, const graph::PlannedBuffer& buffer, std::span<const std::byte> contents);

// The contents for the device. Takes no more memory than the buffer and its file call for, whatever the file says. Throws
// std::runtime_error, naming the file, where it is not just such an array.
std::vector<std::byte> unpack(const graph::Plan& plan, const graph::PlannedBuffer& buffer, const std::filesystem::path& file,
                              std::uint64_t& no_numbers);

}  // namespace firn::app
