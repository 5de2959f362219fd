#pragma once

#include "graph/spec.h"

namespace firn::stages::heightfield {

graph::StageSpec deposit();

}  // namespace firn::stages::heightfield
