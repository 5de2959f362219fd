#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec compress();

}  // namespace firn::stages::heightfield
