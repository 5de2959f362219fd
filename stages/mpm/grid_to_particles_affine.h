#pragma once

#include "graph/spec.h"

namespace firn::stages::mpm {

graph::StageSpec grid_to_particles_affine();

}  // namespace firn::stages::mpm
