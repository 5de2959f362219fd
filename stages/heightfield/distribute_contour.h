#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec distribute_contour();

}  // namespace firn::stages::heightfield
