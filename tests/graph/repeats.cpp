#include "graph/repeats.h"

#include <array>
#include <string>

#include "tests/catch.h"
#include "tests/graph/executions.h"
#include "tests/graph/made_up.h"
#include "tests/graph/plans.h"

// Repeats that end on the device.

namespace firn::test {
namespace {

using enum graph::Access;

graph::Registry registry_of_solvers() {
  graph::Registry registry = made_up_registry();
  graph::StageSpec listed = stage("demo.listed", {port("x", read_write), port("counts", write, "3", graph::ElementType::uint1)});
  listed.work = {graph::Dispatch{.kernel = "list.comp", .over = "1", .uses = {{"counts", write}}},
                 graph::Dispatch{.kernel = "x.comp", .over = "", .indirect = "counts", .uses = {{"x", read_write}}}};
  registry.add(listed);
  graph::StageSpec led = stage("demo.led", {port("x", read_write), port("counts", read, "3", graph::ElementType::uint1)});
  led.work = {graph::Dispatch{.kernel = "x.comp", .over = "", .indirect = "counts", .uses = {{"x", read_write}}}};
  registry.add(led);
  registry.add(stage("demo.count", {port("counts", write, "3", graph::ElementType::uint1)}));
  graph::StageSpec host = stage("demo.host", {port("x", read_write, "points", graph::ElementType::float1, graph::Usage::host)});
  host.work = {graph::HostWork{}};
  registry.add(host, [](const graph::ParameterValues&) { return nullptr; });
  return registry;
}

graph::Plan decided(const std::string& stages, const std::string& max = "8", const std::string& before = "") {
  const Folder folder;
  config::Diagnostics diagnostics;
  const auto file = folder.write("p.yaml", "firn: 1\nsetup: [demo.fill]\nstep:\n" + before + "  - repeat: {max: " + max +
                                               ", until: {buffer: rest, below: 0.5}}\n    stages: " + stages + "\n");
  const graph::PipelineSpec pipeline = graph::load_pipeline(file, {}, diagnostics);
  graph::Plan plan =
      graph::compile(pipeline, registry_of_solvers(), made_up_environment(), diagnostics, {.decide_on_device = true});
  INFO((diagnostics.all().empty() ? std::string{} : to_string(diagnostics.all().front())));
  CHECK_FALSE(diagnostics.has_errors());
  return plan;
}

bool by_device(const graph::Plan& plan) {
  for (const graph::Op& op : plan.step)
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) return repeat->until && repeat->until->progress >= 0;
  return false;
}

TEST_CASE("a repeat of dispatches ends by a kernel that is in the plan with its barriers") {
  graph::Plan plan = decided("[demo.move, demo.measure]");
  REQUIRE(by_device(plan));
  CHECK(text_of(plan, true) ==
        "setup demo.fill x:write:storage; [shader_storage] step repeat 8 { [command] demo.move x:read_write:storage "
        "repeat#1 groups:read:indirect; [shader_storage] demo.measure x:read:storage rest:write:storage "
        "repeat#1 groups:read:indirect; [shader_storage] until rest rest:read:storage repeat#1 progress:read_write:storage "
        "repeat#1 groups:read_write:storage; }");
  CHECK(fault_of(plan, 4, 1).empty());
}

TEST_CASE("every dispatch has its own group counts, which are there from the start") {
  const graph::Plan plan = decided("[demo.move, demo.measure]");
  const graph::PlannedBuffer& groups = plan.buffers.at(static_cast<std::size_t>(plan.buffer("repeat#1 groups")));
  CHECK(groups.initial == std::vector<std::uint32_t>{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
  CHECK(groups.bytes == 48);
  std::vector<int> slots;
  for (const graph::Op& op : plan.step)
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what))
      for (const graph::Op& inner : repeat->body)
        if (const auto* run = std::get_if<graph::Run>(&inner.what)) slots.push_back(run->groups.buffer < 0 ? -1 : run->groups.slot);
  CHECK(slots == std::vector<int>{0, 1, -1});
}

TEST_CASE("the kernel that ends a repeat is a stage without mistakes") {
  for (const graph::PlannedStage& planned : decided("[demo.move, demo.measure]").stages)
    if (planned.spec.name == "repeat.until") {
      CHECK(graph::problems(planned.spec) == std::vector<std::string>{});
      CHECK(planned.label == "until rest");
      CHECK(planned.parameters.at("max_turns") == graph::Value{std::int64_t{8}});
      CHECK(planned.place.line == 4);
    }
}

TEST_CASE("host work, inner repeats with an end, and single turns are left to the host") {
  CHECK_FALSE(by_device(decided("[demo.move, demo.host, demo.measure]")));
  CHECK_FALSE(by_device(decided("[demo.move, demo.measure]", "1")));
  CHECK(by_device(decided("[demo.move, {repeat: 2, stages: [demo.move]}, demo.measure]")));
  const graph::Plan nested =
      decided("[demo.measure, {repeat: {max: 3, until: {buffer: rest, below: 1}}, stages: [demo.move, demo.measure]}]");
  CHECK_FALSE(by_device(nested));
  CHECK(text_of(nested).find("until rest }") != std::string::npos);  // the inner one
}

TEST_CASE("own group counts are zeroed where every turn makes them and nobody else looks at them") {
  const graph::Plan plan = decided("[demo.listed, demo.measure]");
  REQUIRE(by_device(plan));
  CHECK(text_of(plan, true).find("repeat#1 groups:read_write:storage counts:write:storage; }") != std::string::npos);
  CHECK_FALSE(by_device(decided("[demo.led, demo.measure]", "8", "  - demo.count\n")));
  CHECK_FALSE(by_device(decided("[demo.listed, demo.measure]", "8", "  - demo.led\n")));
  CHECK_FALSE(by_device(decided("[{demo.listed: {every: 2}}, demo.measure]")));
}

TEST_CASE("groups are folded where one axis is too short for them") {
  using Counts = std::array<std::uint32_t, 3>;
  CHECK(graph::group_counts(0, 64) == Counts{0, 1, 1});
  CHECK(graph::group_counts(65, 64) == Counts{2, 1, 1});
  CHECK(graph::group_counts(32768 * 64, 64) == Counts{32768, 1, 1});
  CHECK(graph::group_counts(32768 * 64 + 1, 64) == Counts{32768, 2, 1});
}

TEST_CASE("the largest whole number below a limit") {
  CHECK(graph::largest_below(3) == 2);
  CHECK(graph::largest_below(2.5) == 2);
  CHECK(graph::largest_below(-0.5) == -1);
  CHECK(graph::largest_below(1e12) == 2147483647);
}

}  // namespace
}  // namespace firn::test
