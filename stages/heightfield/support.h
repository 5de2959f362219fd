#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec support();

}  // namespace firn::stages::heightfield
