#pragma once

// JSON Schema (draft-07) of Firn's files: editors complete and check by it while one writes. What it cannot say - whether a buffer
// is written before it is read, whether a file exists - `firn check` says.

#include <nlohmann/json.hpp>

#include "graph/registry.h"

namespace firn::app {

nlohmann::json pipeline_schema(const graph::Registry& registry);
nlohmann::json scene_schema();

}  // namespace firn::app
