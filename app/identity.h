#pragma once

// What decides how a simulation goes on from a given state: two runs with the same identity do the same.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/load.h"

namespace firn::app {

// {"pipeline": stages with their parameters and buffers, and their order; "scene": its text, overrides applied; "files": hashes of
// what the scene names; "sizes": elements of every domain; "shaders": hashes of all source that a device is given}
nlohmann::json identity_of(const Loaded& loaded);

// The ways in which the second differs from the first, one sentence part each ("scene.gravity is [0, -1.62, 0], was [0, -9.81,
// 0]"); empty: in nothing that counts. When a scene ends, and what it says of itself, does not count.
std::vector<std::string> differences(const nlohmann::json& before, const nlohmann::json& now);

}  // namespace firn::app
