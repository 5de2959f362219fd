#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec distance_transform();

}  // namespace firn::stages::heightfield
