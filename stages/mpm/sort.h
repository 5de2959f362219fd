#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec sort();

}  // namespace firn::stages::mpm
