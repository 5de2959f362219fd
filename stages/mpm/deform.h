#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec deform();

}  // namespace firn::stages::mpm
