#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec grid_to_particles();

}  // namespace firn::stages::mpm
