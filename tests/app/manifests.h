#pragma once

#include <nlohmann/json.hpp>

#include "tests/app/child.h"

namespace firn::test {

// What a run has left in its folder for results.
inline nlohmann::json manifest_in(const std::filesystem::path& run) {
  return nlohmann::json::parse(read_file(run / "manifest.json"));
}

}  // namespace firn::test
