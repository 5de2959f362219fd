#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec gather_velocities();

}  // namespace firn::stages::mpm
