#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec grid_forces();

}  // namespace firn::stages::mpm
