#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec particles_to_grid();

}  // namespace firn::stages::mpm
