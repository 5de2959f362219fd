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

void stages_of(const std::vector<graph::Op>& ops, std::vector<const graph::PlannedStage*>& stages, const graph::Plan& plan) {
  for (const graph::Op& op : ops) {
    if (const auto* run = std::get_if<graph::Run>(&op.what)) stages.push_back(&plan.stages[static_cast<std::size_t>(run->stage)]);
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) stages_of(repeat->body, stages, plan);
  }
}

// Why an order cannot be: "stage reads 'buffer', written for an earlier 'list'". Found by looking back from every read for what was
// last written; the plan may be one that was refused.
std::set<std::string> reasons_against(const graph::Plan& plan) {
  std::vector<const graph::PlannedStage*> order;
  for (const auto* phase : {&plan.setup, &plan.frame, &plan.step, &plan.step, &plan.frame}) stages_of(*phase, order, plan);
  const auto touches = [&](const graph::PlannedStage& stage, int buffer, bool (*how)(graph::Access)) {
    for (std::size_t p = 0; p < stage.buffers.size(); ++p)
      if (stage.buffers[p] == buffer && how(stage.spec.ports[p].access)) return true;
    return false;
  };
  const auto last_writer = [&](int buffer, std::ptrdiff_t before) {
    while (--before >= 0 && !touches(*order[static_cast<std::size_t>(before)], buffer, graph::writes)) {
    }
    return before;
  };
  std::set<std::string> reasons;
  for (std::size_t at = 0; at < order.size(); ++at)
    for (std::size_t p = 0; p < order[at]->buffers.size(); ++p) {
      const graph::Port& port = order[at]->spec.ports[p];
      const auto listed = plan.environment.listed_by.find(graph::base_domain(port.domain));
      if (listed == plan.environment.listed_by.end() || !graph::reads(port.access) || order[at]->buffers[p] < 0) continue;
      const int list = plan.buffer(listed->second), buffer = order[at]->buffers[p];
      const auto here = static_cast<std::ptrdiff_t>(at);
      const std::ptrdiff_t written = last_writer(buffer, here);
      if (touches(*order[at], list, graph::writes) || written < 0 || written >= last_writer(list, here)) continue;
      reasons.insert(fmt::format("{} reads '{}', which was written for an earlier '{}'; it must be written again first",
                                 order[at]->label, plan.buffers[static_cast<std::size_t>(buffer)].name, listed->second));
    }
  return reasons;
}

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

TEST_CASE("a shipped pipeline with its steps in any order is refused for the right reason, or free of hazards") {
  const std::uint64_t first = seed();
  const int count = std::getenv("FIRN_LONG") != nullptr ? 10'000 : 1'000;
  for (const std::string& name : shipped_pipelines()) {
    const Shipped shipped(name);
    int refused = 0;
    bool lists = false;
    for (int i = 0; i < count; ++i) {
      std::mt19937_64 random(first + static_cast<std::uint64_t>(i));
      graph::PipelineSpec shuffled = shipped.pipeline;
      std::shuffle(shuffled.step.begin(), shuffled.step.end(), random);
      config::Diagnostics diagnostics;
      const graph::Plan plan = shipped.plan(shuffled, {.share_memory = i % 2 == 0, .decide_on_device = i % 4 < 2}, diagnostics);
      INFO(name << ", seed " << first + static_cast<std::uint64_t>(i));
      std::set<std::string> told;
      for (const config::Diagnostic& one : diagnostics.all()) {
        if (one.severity != config::Severity::error) continue;
        told.insert(one.text);
        const auto stage = std::ranges::find(plan.stages, one.text.substr(0, one.text.find(' ')), &graph::PlannedStage::label);
        REQUIRE(stage != plan.stages.end());
        CHECK(to_string(one.place) == to_string(stage->place));
      }
      REQUIRE(told == reasons_against(plan));
      refused += told.empty() ? 0 : 1;
      lists |= plan.buffer("active_blocks") >= 0;
      if (!told.empty()) continue;
      const auto hazard = first_hazard(plan, executions(plan, 3, first));
      REQUIRE((hazard ? describe(plan, *hazard) : "") == "");
    }
    CAPTURE(name);
    CHECK((refused > 0) == lists);
  }
}

}  // namespace
}  // namespace firn::test
