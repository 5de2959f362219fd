#pragma once

#include "graph/spec.h"

namespace firn::stages::render {

graph::StageSpec shadow_map();

}  // namespace firn::stages::render
