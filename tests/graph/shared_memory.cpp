#include <map>
#include <set>
#include <string>
#include <vector>

#include "graph/buffer_uses.h"
#include "tests/catch.h"
#include "tests/graph/executions.h"
#include "tests/graph/made_up.h"
#include "tests/graph/plans.h"

// Scratch buffers whose lives do not meet.

namespace firn::test {
namespace {

constexpr const char* chain_text =
    "firn: 1\nsetup: [demo.fill]\nstep:\n"
    "  - demo.copy: {bind: {y: a}}\n"
    "  - demo.copy: {bind: {x: a, y: b}}\n"
    "  - demo.copy: {bind: {x: b, y: c}}\n"
    "  - demo.copy: {bind: {x: c, y: d}}\n"
    "  - demo.copy: {bind: {x: d, y: x}}\n";

graph::Plan planned(const std::string& yaml, bool share = true, const std::set<std::string>& provided = {}) {
  const Folder folder;
  config::Diagnostics diagnostics;
  const graph::PipelineSpec pipeline = graph::load_pipeline(folder.write("p.yaml", yaml), {}, diagnostics);
  graph::Environment environment = made_up_environment();
  environment.provided = provided;
  graph::Plan plan = graph::compile(pipeline, made_up_registry(), environment, diagnostics, {.share_memory = share});
  CHECK_FALSE(diagnostics.has_errors());
  return plan;
}

// "a c, b d": names of those that share, in the order of the buffers.
std::string shared(const graph::Plan& plan) {
  std::map<int, std::vector<std::string>> members;
  for (const graph::PlannedBuffer& buffer : plan.buffers) members[buffer.storage].push_back(buffer.name);
  std::vector<std::string> groups;
  for (const auto& [storage, names] : members)
    if (names.size() > 1) groups.push_back(fmt::format("{}", fmt::join(names, " ")));
  return fmt::format("{}", fmt::join(groups, ", "));
}

TEST_CASE("scratch buffers share memory where their lives do not meet") {
  graph::Plan plan = planned(chain_text);
  CHECK(shared(plan) == "a c, b d");
  CHECK(plan.bytes == 3 * 40);
  CHECK(fault_of(plan, 4, 1).empty());
}

TEST_CASE("without sharing every buffer has memory of its own") {
  const graph::Plan plan = planned(chain_text, false);
  CHECK(shared(plan).empty());
  CHECK(plan.bytes == 5 * 40);
}

TEST_CASE("a write into memory that was another buffer's waits for what was done there, and says so") {
  graph::Plan plan = planned(chain_text);
  // Whoever writes c waits for the reader of a, which is the command before.
  std::vector<std::string> reasons;
  for (const graph::Barrier* barrier : collect_barriers(plan))
    reasons.insert(reasons.end(), barrier->reasons.begin(), barrier->reasons.end());
  INFO(fmt::format("{}", fmt::join(reasons, "\n")));
  CHECK(std::ranges::find(reasons, "c, in memory that was a's: read by demo.copy#2, written by demo.copy#3") != reasons.end());
}

TEST_CASE("what lives beyond the step, or goes elsewhere, shares nothing") {
  CHECK(shared(planned(std::string(chain_text) + "frame:\n  - demo.look: {bind: {x: a}}\n")) == "b d");
  CHECK(shared(planned(chain_text, true, {"a", "d"})).empty());
  CHECK(shared(planned(std::string(chain_text) + "  - demo.look: {bind: {x: a}}\n")) == "b d");
}

TEST_CASE("only a write of every element begins a buffer anew") {
  const graph::Port cells = port("x", graph::Access::write, "cells");
  const graph::Port few = port("x", graph::Access::write, "3");
  const auto over = [](const std::string& domain) { return graph::Work{graph::Dispatch{.kernel = "k.comp", .over = domain}}; };
  const graph::Work listed = graph::Dispatch{.kernel = "k.comp", .over = "", .indirect = "groups"};
  CHECK(graph::writes_all(over("cells"), cells, graph::Access::write));
  CHECK_FALSE(graph::writes_all(over("cells"), cells, graph::Access::read_write));
  CHECK_FALSE(graph::writes_all(over("points"), cells, graph::Access::write));
  CHECK_FALSE(graph::writes_all(listed, cells, graph::Access::write));
  CHECK(graph::writes_all(over("1"), few, graph::Access::write));
  CHECK_FALSE(graph::writes_all(listed, few, graph::Access::write));
  CHECK(graph::writes_all(graph::HostWork{}, cells, graph::Access::write));
}

TEST_CASE("a buffer that the setup begins anew as well is scratch, one that the setup reads first is not") {
  const std::string copies = "  - demo.copy: {bind: {y: a}}\n  - demo.copy: {bind: {x: a}}\n";
  const auto lifetime = [](const std::string& yaml) {
    const graph::Plan plan = planned(yaml);
    return plan.buffers.at(static_cast<std::size_t>(plan.buffer("a"))).lifetime;
  };
  CHECK(lifetime("firn: 1\nsetup:\n  - demo.fill\n" + copies + "step:\n" + copies + "  - demo.show\n") == graph::Lifetime::scratch);
  CHECK(lifetime("firn: 1\nsetup:\n  - demo.fill\n  - demo.look: {bind: {x: a}}\nstep:\n" + copies + "  - demo.show\n") ==
        graph::Lifetime::state);
}

TEST_CASE("a repeat is one place: what is used in it lives through all of it") {
  CHECK(shared(planned("firn: 1\nsetup: [demo.fill]\nstep:\n"
                       "  - demo.copy: {bind: {y: a}}\n"
                       "  - repeat: 3\n"
                       "    stages:\n"
                       "      - demo.copy: {bind: {x: a, y: b}}\n"
                       "      - demo.copy: {bind: {x: b, y: c}}\n"
                       "      - demo.copy: {bind: {x: c, y: d}}\n"
                       "  - demo.copy: {bind: {x: d, y: e}}\n"
                       "  - demo.copy: {bind: {x: e, y: x}}\n")) == "a e");
}

TEST_CASE("a small buffer lives in the memory of a large one, which is counted once") {
  graph::Registry registry = made_up_registry();
  registry.add(stage("demo.sum", {port("x", graph::Access::read), port("sum", graph::Access::write, "1")}));
  registry.add(stage("demo.use", {port("sum", graph::Access::read, "1"), port("big", graph::Access::write, "points*8")}));
  registry.add(stage("demo.take", {port("big", graph::Access::read, "points*8"), port("small", graph::Access::write, "4")}));
  registry.add(stage("demo.end", {port("small", graph::Access::read, "4"), port("x", graph::Access::read_write)}));
  const Folder folder;
  config::Diagnostics diagnostics;
  const auto file = folder.write("p.yaml", "firn: 1\nsetup: [demo.fill]\nstep: [demo.sum, demo.use, demo.take, demo.end]\n");
  const graph::PipelineSpec pipeline = graph::load_pipeline(file, {}, diagnostics);
  const graph::Plan plan = graph::compile(pipeline, registry, made_up_environment(), diagnostics, {.share_memory = true});
  CHECK(shared(plan) == "sum small");
  CHECK(plan.bytes == 40 + 16 + 320);
}

TEST_CASE("the model counts buffers that share memory as one") {
  graph::Plan plan = PlanText("step a x:write; b y:write").plan();
  CHECK_FALSE(first_hazard(plan, executions(plan, 1, 1)));
  plan.buffers[1].storage = plan.buffers[0].storage;
  const auto hazard = first_hazard(plan, executions(plan, 1, 1));
  REQUIRE(hazard);
  CHECK(hazard->kind == HazardKind::write_after_write);
}

}  // namespace
}  // namespace firn::test
