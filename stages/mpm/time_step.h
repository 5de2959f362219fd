#pragma once

#include "graph/registry.h"
#include "stages/problem.h"

namespace firn::stages::mpm {

graph::StageSpec time_step();
// Reads the fastest speed and sets the length of the step, at most the one asked for.
graph::HostFactory time_stepping(std::shared_ptr<const Problem> problem);

}  // namespace firn::stages::mpm
