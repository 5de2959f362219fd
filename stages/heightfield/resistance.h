#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec resistance();

}  // namespace firn::stages::heightfield
