#pragma once

#include "graph/registry.h"
#include "stages/problem.h"

namespace firn::stages::io {

graph::StageSpec video();
// Writes below the problem's output folder; nothing where there is none.
graph::HostFactory writing_video(std::shared_ptr<const Problem> problem);

}  // namespace firn::stages::io
