#pragma once

// A plan for people and programs to read.

#include <nlohmann/json.hpp>
#include <string>

#include "graph/explain_accesses.h"
#include "graph/plan.h"
#include "graph/single_use.h"
#include "stages/forms.h"

namespace firn::app {

// The kernel's file below shaders/ (of a stage that is a file, its name), a draw's name, or "host".
std::string work_name(const graph::Work& work);

// Which forms of kernels the plan has, for which device, and why.
struct FormsOfPlan {
  stages::DeviceProfile device;
  std::string reason;
  std::vector<graph::AutomaticChoice> choices;
};
nlohmann::json forms_as_json(const FormsOfPlan& forms);
std::string forms_as_text(const FormsOfPlan& forms);

// {"pipeline", "phases": {"setup", "step", "frame"}, "buffers", "memory"} as documented in docs/explain.md, and beside these
// "bindings" and "unhindered": accesses that no barrier was placed for.
nlohmann::json explain_as_json(const graph::Plan& plan);

std::string explain_as_text(const graph::Plan& plan, const std::string& doc);

// For Graphviz: stages as boxes by phase, in order; barriers between and in them; buffers as edges from who wrote to who reads.
std::string explain_as_dot(const graph::Plan& plan, const std::string& doc);

}  // namespace firn::app
