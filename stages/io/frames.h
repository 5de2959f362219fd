#pragma once

#include "stages/export.h"

namespace firn::stages::io {

graph::StageSpec frames();
// Writes below the problem's output folder; nothing where there is none.
graph::HostFactory writing_frames(const Exports& exports);

}  // namespace firn::stages::io
