#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec grid_update();

}  // namespace firn::stages::mpm
