#pragma once

#include "graph/environment.h"

namespace firn::app {

// Adds to the reasons why domains and constants are missing which of the scenes that come with Firn have them. Reads those scenes.
void name_scenes_that_would_do(graph::Environment& environment);

}  // namespace firn::app
