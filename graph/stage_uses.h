#pragma once

// Lists of stages, repeats and groups, as a pipeline file writes them.

#include <functional>
#include <string>
#include <vector>

#include "graph/pipeline.h"

namespace firn::graph {

// Appends what `list` says. `what` names the list in errors, `parameters` are the pipeline's, for `when`.
void read_items(const config::Node& list, const std::string& what, const config::Node& parameters, std::vector<Item>& items,
                config::Diagnostics& diagnostics);

// One option of a stage: bind, every, enable, as, when; everything else is one of its parameters.
void read_option(const config::Entry& option, const config::Node& parameters, StageUse& use, config::Diagnostics& diagnostics);

// Visits every use of a stage, those in repeats as well.
void each_use(std::vector<Item>& items, const std::function<void(StageUse&)>& visit);

}  // namespace firn::graph
