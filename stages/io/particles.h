#pragma once

#include "stages/export.h"

namespace firn::stages::io {

graph::StageSpec particles();
graph::HostFactory writing_particles(const Exports& exports);

}  // namespace firn::stages::io
