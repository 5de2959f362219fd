#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec stress();

}  // namespace firn::stages::mpm
