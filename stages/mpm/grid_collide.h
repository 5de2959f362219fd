#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec grid_collide();

}  // namespace firn::stages::mpm
