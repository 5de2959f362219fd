#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec deform_stress();

}  // namespace firn::stages::mpm
