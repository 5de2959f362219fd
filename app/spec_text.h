#pragma once

// The spec of a stage, for people and for machines.

#include <nlohmann/json.hpp>
#include <string>

#include "graph/environment.h"
#include "graph/spec.h"

namespace firn::app {

std::string describe(const graph::Work& work);                 // "mpm/sort_begin.comp over grid_rows, in groups of 64"
std::string describe_range(const graph::ParameterSpec& spec);  // "0 to 1", "from 1", "cubic or quadratic", "any"

// `known` has units and docs of constants.
nlohmann::json spec_json(const graph::StageSpec& spec, const graph::Environment& known);
void print_spec(const graph::StageSpec& spec, const graph::Environment& known);

}  // namespace firn::app
