#pragma once

#include "graph/registry.h"
#include "stages/problem.h"

namespace firn::stages::render {

graph::StageSpec particles();
// Hands the materials' colours to the kernels.
graph::HostFactory coloring(std::shared_ptr<const Problem> problem);

}  // namespace firn::stages::render
