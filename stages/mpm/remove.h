#pragma once

#include "graph/registry.h"
#include "stages/problem.h"

namespace firn::stages::mpm {

graph::StageSpec remove();
// Takes away the particles in the problem's sinks.
graph::HostFactory removing(std::shared_ptr<const Problem> problem);

}  // namespace firn::stages::mpm
