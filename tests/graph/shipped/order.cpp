#include <fmt/format.h>

#include <cstdlib>
#include <random>
#include <set>

#include "tests/catch.h"
#include "tests/graph/executions.h"
#include "tests/graph/shipped/shipped.h"

// Barriers of shipped pipelines, as they are and with their stages moved about.

namespace firn::test {
namespace {

TEST_CASE("barriers of shipped pipelines leave no hazard, and none of their bits could be missing") {
  for (const std::string& name : shipped_pipelines()) {
    const Shipped shipped(name);
    for (const bool share : {false, true})
      for (const bool by_device : {false, true}) {
        graph::Plan plan = shipped.plan({.share_memory = share, .decide_on_device = by_device});
        CAPTURE(name, share, by_device);
        CHECK(fault_of(plan, 3, 1) == "");
      }
  }
}

TEST_CASE("a shipped pipeline with its steps in any order is refused with a reason, or free of hazards") {
  const std::uint64_t first = seed();
  const int count = std::getenv("FIRN_LONG") != nullptr ? 10'000 : 1'000;
  for (const std::string& name : shipped_pipelines()) {
    const Shipped shipped(name);
    int refused = 0, hazards = 0;
    for (int i = 0; i < count; ++i) {
      std::mt19937_64 random(first + static_cast<std::uint64_t>(i));
      graph::PipelineSpec shuffled = shipped.pipeline;
      std::shuffle(shuffled.step.begin(), shuffled.step.end(), random);
      config::Diagnostics diagnostics;
      const graph::Plan plan = shipped.plan(shuffled, {.share_memory = i % 2 == 0, .decide_on_device = i % 4 < 2}, diagnostics);
      INFO(name << ", seed " << first + static_cast<std::uint64_t>(i));
      if (diagnostics.has_errors()) {
        ++refused;
        for (const config::Diagnostic& diagnostic : diagnostics.all())
          if (diagnostic.place.line == 0 || diagnostic.text.empty()) FAIL_CHECK("a reason without a place or text");
        continue;
      }
      if (const auto hazard = first_hazard(plan, executions(plan, 3, first))) {
        ++hazards;
        FAIL_CHECK(describe(plan, *hazard));
        break;
      }
    }

    CHECK(hazards == 0);
  }
}

}  // namespace
}  // namespace firn::test
