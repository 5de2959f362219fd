#pragma once

// What each barrier of a plan is there for.

#include <string>
#include <unordered_map>
#include <vector>

#include "graph/plan.h"

namespace firn::graph {

struct BarrierNeed {
  Bits bits = 0;                     // that could not be missing
  std::vector<std::string> reasons;  // the accesses that would be open without the barrier
};

struct BarrierNeeds {
  bool complete = true;  // no access is open
  std::unordered_map<const Barrier*, BarrierNeed> of;
};

// Plays setup and all pairs of phases once; every barrier is judged as if it alone were missing.
BarrierNeeds barrier_needs(const Plan& plan);

}  // namespace firn::graph
