#pragma once

#include "stages/export.h"

namespace firn::stages::io {

graph::StageSpec bodies();
graph::HostFactory writing_bodies(const Exports& exports);

}  // namespace firn::stages::io
