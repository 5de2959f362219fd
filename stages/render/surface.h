#pragma once

#include "graph/registry.h"
#include "stages/problem.h"

namespace firn::stages::render {

graph::StageSpec surface();
// Makes the mesh. Throws std::runtime_error in a build without OpenVDB, and while drawing where the mesh is larger than its
// buffers.
graph::HostFactory meshing(std::shared_ptr<const Problem> problem);

}  // namespace firn::stages::render
