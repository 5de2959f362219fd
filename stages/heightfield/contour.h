#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec contour();

}  // namespace firn::stages::heightfield
