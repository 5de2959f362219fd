#pragma once

#include "graph/registry.h"
#include "stages/problem.h"

namespace firn::stages::heightfield {

graph::StageSpec init();
// Writes the scene's field. Throws config::InputError where its images cannot be read or do not fit.
graph::HostFactory initialising(std::shared_ptr<const Problem> problem);

}  // namespace firn::stages::heightfield
