#pragma once

#include "graph/registry.h"
#include "stages/problem.h"

namespace firn::stages::bodies {

graph::StageSpec place();
// Writes the scene's rigid bodies. Throws config::InputError for shapes that no stage can use yet.
graph::HostFactory placing(std::shared_ptr<const Problem> problem);

}  // namespace firn::stages::bodies
