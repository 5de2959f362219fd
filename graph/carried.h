#pragma once

// What a plan carries from one step to the next: all that a checkpoint must hold.

#include <vector>

#include "graph/plan.h"

namespace firn::graph {

// The buffers and pictures whose contents a later step or frame may read before it has written them anew as a whole; in the order
// of the plan. What is stored for the entries of a list is void once the list is made anew (listed_domains.h). Unlike
// Lifetime::state this does not depend on what is kept for other reasons, and leaves out pictures that every frame begins by
// clearing them.
std::vector<int> carried(const Plan& plan);

}  // namespace firn::graph
