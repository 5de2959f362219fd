#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec flatten();

}  // namespace firn::stages::heightfield
