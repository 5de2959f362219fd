#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec clear_grid();

}  // namespace firn::stages::mpm
