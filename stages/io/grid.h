#pragma once

#include "stages/export.h"

namespace firn::stages::io {

graph::StageSpec grid();
// Throws std::runtime_error for `format: vdb` in a build without OpenVDB.
graph::HostFactory writing_grid(const Exports& exports);

}  // namespace firn::stages::io
