#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec underside();

}  // namespace firn::stages::heightfield
