// How long planning takes: from a pipeline of so many stages to its plan, barriers and shared memory included. No device.

#include <fmt/format.h>

#include <chrono>
#include <random>

#include "app/bench.h"

namespace firn::app {
namespace {

using graph::Access;

graph::StageSpec made_up(const std::string& name, const std::vector<std::pair<std::string, Access>>& ports) {
  graph::StageSpec spec{.name = name, .doc = "made up", .equation = "", .ports = {}, .work = {}};
  for (const auto& [port, access] : ports)
    spec.ports.push_back(
        {.name = port, .type = graph::ElementType::float1, .domain = "points", .access = access, .unit = "1", .doc = "made up"});
  spec.work = {graph::Dispatch{.kernel = "made_up.comp", .over = "points"}};
  return spec;
}

graph::Registry made_up_stages() {
  graph::Registry registry;
  registry.add(made_up("made_up.fill", {{"result", Access::write}}));
  registry.add(made_up("made_up.combine", {{"one", Access::read}, {"other", Access::read}, {"result", Access::write}}));
  registry.add(made_up("made_up.add", {{"one", Access::read}, {"result", Access::accumulate}}));
  registry.add(made_up("made_up.change", {{"result", Access::read_write}}));
  return registry;
}

// As pipelines are: a buffer for every few stages, ten stages work on what was written not long before.
graph::PipelineSpec pipeline_of(int stages) {
  std::mt19937 random(1);
  const auto below = [&](int limit) { return static_cast<int>(random() % static_cast<unsigned>(limit)); };
  const int buffers = std::clamp(stages / 4, 4, 1000);  // a pipeline may have 2,000
  const auto buffer = [](int number) { return fmt::format("buffer{}", number); };
  graph::PipelineSpec pipeline;
  pipeline.file = pipeline.name = fmt::format("{} stages", stages);
  int uses = 0;
  const auto use = [&](std::vector<graph::Item>& phase, const std::string& stage,
                       const std::vector<std::pair<std::string, int>>& ports) {
    graph::StageUse one;
    one.stage = stage;
    one.label = fmt::format("{}#{}", stage, ++uses);
    for (const auto& [port, number] : ports) one.bindings.push_back({port, buffer(number), {}});
    phase.emplace_back().what = one;
  };
  for (int b = 0; b < buffers; ++b) use(pipeline.setup, "made_up.fill", {{"result", b}});
  for (int s = 0; s < stages; ++s) {
    const int result = static_cast<int>(std::int64_t{s} * buffers / stages);
    const auto near = [&] { return (result + 1 + below(std::min(20, buffers - 1))) % buffers; };
    if (s % 4 == 0)
      use(pipeline.step, "made_up.fill", {{"result", result}});
    else if (const int kind = below(3); kind == 0)
      use(pipeline.step, "made_up.combine", {{"one", near()}, {"other", near()}, {"result", result}});
    else if (kind == 1)
      use(pipeline.step, "made_up.add", {{"one", near()}, {"result", result}});
    else
      use(pipeline.step, "made_up.change", {{"result", result}});
  }
  return pipeline;
}

}  // namespace

void bench_graph(Bench& bench) {
  const graph::Registry registry = made_up_stages();
  graph::Environment environment;
  environment.domains["points"] = {1000};
  for (const int stages : {10, 100, 1000, 10000}) {
    BenchResult result{fmt::format("graph/{}", stages), {}};
    if (!bench.wants(result.name)) continue;
    result.count = stages;
    result.unit = "stages/s";
    result.series = "planning";
    result.along = "stages";
    result.x = stages;
    const graph::PipelineSpec pipeline = pipeline_of(stages);
    const int times = 10000 / stages / 10 + 1;  // of one run: short ones would be lost in the clock
    for (int run = 0; run <= bench.runs(); ++run) {
      const auto start = std::chrono::steady_clock::now();
      for (int i = 0; i < times; ++i) {
        config::Diagnostics diagnostics;
        graph::compile(pipeline, registry, environment, diagnostics, {.share_memory = true});
        config::throw_if_errors(diagnostics);
      }
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / times;
      if (run > 0) result.seconds.push_back(seconds);  // the first only warms up
    }
    bench.add(result);
  }
}

}  // namespace firn::app
