#include <cstdlib>
#include <string>

#include "graph/barriers.h"
#include "tests/catch.h"
#include "tests/graph/executions.h"
#include "tests/graph/plans.h"
#include "tests/graph/random_plan.h"

namespace firn::test {
namespace {

TEST_CASE("barriers of random plans leave no hazard, and none of their bits could be missing") {
  const bool is_long = std::getenv("FIRN_LONG") != nullptr;
  const std::uint64_t count = is_long ? 100'000 : 2'000;
  const std::uint64_t first = seed();
  for (std::uint64_t i = 0; i < count; ++i) {
    graph::Plan plan = RandomPlan(first + i).plan();
    const std::string before = text_of(plan, true);
    graph::place_barriers(plan);
    const std::string fault = fault_of(plan, 5, first + i);
    if (fault.empty()) continue;
    INFO("seed " << first + i << "\nplan   " << before << "\nplaced " << text_of(plan));
    FAIL_CHECK(fault);
    return;
  }
  SUCCEED("seeds " << first << " to " << first + count - 1);
}

}  // namespace
}  // namespace firn::test
