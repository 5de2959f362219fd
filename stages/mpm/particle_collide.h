#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec particle_collide();

}  // namespace firn::stages::mpm
