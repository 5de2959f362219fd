#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec active_blocks_stage();

}  // namespace firn::stages::mpm
