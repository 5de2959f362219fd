#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec initial_density();

}  // namespace firn::stages::mpm
