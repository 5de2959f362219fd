#pragma once

#include "graph/spec.h"

namespace firn::stages::bodies {

graph::StageSpec integrate();

}  // namespace firn::stages::bodies
