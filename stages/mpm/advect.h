#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec advect();

}  // namespace firn::stages::mpm
