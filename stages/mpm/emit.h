#pragma once

#include "graph/registry.h"
#include "stages/problem.h"

namespace firn::stages::mpm {

graph::StageSpec emit();
// Brings the particles that the problem's emitters have due.
graph::HostFactory emitting(std::shared_ptr<const Problem> problem);

}  // namespace firn::stages::mpm
