#pragma once

// Why each access of a plan is in order: the barrier it waits for, or why it needs none.

#include <string>
#include <vector>

#include "graph/plan.h"

namespace firn::graph {

struct AccessNote {
  enum class Order {
    own_barrier,      // the barrier right before this work
    earlier_barrier,  // one that was placed for other work, and serves this access as well
    none_needed,
    missing  // none, though one is needed: never in a plan that compile() made
  };
  Order order = Order::none_needed;
  std::string why;  // "written by mpm.sort, waited for before mpm.stress"
};

// One entry per run in the order of the plan, those in repeats once, each with a note per access; where the host looks for the end
// of a repeat, one more behind its body. Of a step that follows a step, a frame that follows a step, a turn that follows a turn.
using RunNotes = std::vector<std::vector<AccessNote>>;
struct PlanNotes {
  RunNotes setup, step, frame;
};
PlanNotes explain_accesses(const Plan& plan);

}  // namespace firn::graph
