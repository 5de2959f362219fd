#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec gather_affine();

}  // namespace firn::stages::mpm
