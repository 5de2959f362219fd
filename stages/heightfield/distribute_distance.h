#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec distribute_distance();

}  // namespace firn::stages::heightfield
