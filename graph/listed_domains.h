#pragma once

#include "config/diagnostics.h"
#include "graph/plan.h"

namespace firn::graph {

// Some domains are made anew in every step: which elements there are is what a buffer of the environment's `listed_by` says. What
// was written for an earlier list must not be read with a later one: that is an error at the reading stage.
void check_listed_domains(const Plan& plan, config::Diagnostics& diagnostics);

}  // namespace firn::graph
