#pragma once

#include "graph/spec.h"

namespace firn::stages::render {

graph::StageSpec heightfield();

}  // namespace firn::stages::render
