#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec overlap();

}  // namespace firn::stages::heightfield
