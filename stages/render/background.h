#pragma once

#include "graph/spec.h"

namespace firn::stages::render {

graph::StageSpec background();

}  // namespace firn::stages::render
