#pragma once

#include "stages/export.h"

namespace firn::stages::io {

graph::StageSpec heightfield_files();
graph::HostFactory writing_heightfield(const Exports& exports);

}  // namespace firn::stages::io
