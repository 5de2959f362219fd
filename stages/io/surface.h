#pragma once

#include "stages/export.h"

namespace firn::stages::io {

graph::StageSpec surface();
// Throws std::runtime_error in a build without OpenVDB.
graph::HostFactory writing_surface(const Exports& exports);

}  // namespace firn::stages::io
