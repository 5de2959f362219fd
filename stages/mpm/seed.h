#pragma once

#include "graph/registry.h"
#include "stages/problem.h"

namespace firn::stages::mpm {

graph::StageSpec seed();
// Writes the problem's particles and materials.
graph::HostFactory seeding(std::shared_ptr<const Problem> problem);

}  // namespace firn::stages::mpm
