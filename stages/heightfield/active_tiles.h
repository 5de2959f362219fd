#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec active_tiles();

}  // namespace firn::stages::heightfield
