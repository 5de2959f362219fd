#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/graph/executions.h"
#include "tests/graph/shipped/shipped.h"

// Barriers order accesses; they do not keep a buffer's contents from one that shares its memory. Lifetimes do.

namespace firn::test {
namespace {

// Reads of a buffer in whose memory another one has been written since it was itself: "a, lost to b".
std::vector<std::string> lost_contents(const graph::Plan& plan) {
  const auto every_turn = [](const graph::Repeat& repeat) { return repeat.max; };
  const auto all_run = [](int) { return true; };
  std::vector<int> owner(plan.buffers.size(), -1);  // by storage
  std::vector<std::string> lost;
  for (const Event& event : trace(plan, "ssfsf", {every_turn, all_run})) {
    const auto owner_of = [&](const graph::BufferAccess& access) -> int& {
      return owner[static_cast<std::size_t>(plan.buffers[static_cast<std::size_t>(access.buffer)].storage)];
    };
    for (const graph::BufferAccess& access : event.accesses)
      if (const int last = owner_of(access); graph::reads(access.access) && last >= 0 && last != access.buffer)
        lost.push_back(plan.buffers[static_cast<std::size_t>(access.buffer)].name + ", lost to " +
                       plan.buffers[static_cast<std::size_t>(last)].name);
    for (const graph::BufferAccess& access : event.accesses)
      if (graph::writes(access.access)) owner_of(access) = access.buffer;
  }
  return lost;
}

TEST_CASE("buffers of shipped pipelines that share memory lose nothing that is read later") {
  for (const std::string& name : shipped_pipelines()) {
    const Shipped shipped(name);
    for (const bool by_device : {false, true}) {
      const graph::Plan plan = shipped.plan({.share_memory = true, .decide_on_device = by_device});
      CAPTURE(name, by_device);
      CHECK(lost_contents(plan) == std::vector<std::string>{});
    }
  }
}

TEST_CASE("a shuffled shipped pipeline that shares memory loses nothing that is read later") {
  const std::uint64_t first = seed();
  INFO("seed " << first);
  std::mt19937_64 random(first);
  for (const std::string& name : shipped_pipelines()) {
    const Shipped shipped(name);
    for (int i = 0; i < 100; ++i) {
      graph::PipelineSpec shuffled = shipped.pipeline;
      std::ranges::shuffle(shuffled.step, random);
      config::Diagnostics diagnostics;
      const graph::Plan plan = shipped.plan(shuffled, {.share_memory = true, .decide_on_device = i % 2 == 0}, diagnostics);
      if (diagnostics.has_errors()) continue;
      CAPTURE(name, i);
      CHECK(lost_contents(plan) == std::vector<std::string>{});
    }
  }
}

TEST_CASE("a buffer that shares memory while it is still read is found out") {
  const Shipped shipped("mpm_snow.yaml");
  graph::Plan plan = shipped.plan({.share_memory = true});
  const int velocity = plan.buffer("velocity"), position = plan.buffer("position");
  REQUIRE((velocity >= 0 && position >= 0));
  plan.buffers[static_cast<std::size_t>(velocity)].storage = plan.buffers[static_cast<std::size_t>(position)].storage;
  CHECK_FALSE(lost_contents(plan).empty());
}

}  // namespace
}  // namespace firn::test
