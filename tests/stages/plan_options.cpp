// Ways to plan a shipped pipeline that must not matter to what it computes.

#include "app/arrays.h"
#include "tests/catch.h"
#include "tests/stages/ball_scene.h"
#include "tests/stages/simulation.h"

using namespace firn;
using namespace firn::test;

namespace {

// One ball rolls on its way, one falls: piles that slide for some passes and then rest.
const char* const field_text = R"(
firn: 1
name: field
materials: {snow: {preset: settled, min_density: 80}}
time: {dt: 5.0e-3, end: 2}
field: {size: [4, 4], cells: [64, 64], ground: 0.1, depth: 0.4, density: 100, material: snow}
bodies:
  - {sphere: {radius: 0.5}, path: [{t: 0, position: [1, 0.7, 2]}, {t: 1, position: [3, 0.6, 2]}]}
  - {sphere: {radius: 0.3}, mass: 20, position: [2, 1, 3.2]}
)";

struct Run {
  std::map<std::string, std::vector<std::byte>> state;  // buffers that live beyond a step
  std::uint64_t bytes = 0, turns = 0;
  bool by_device = false;
};

Run run(const std::string& pipeline, const std::string& scene_text, int steps, const graph::PlanOptions& options) {
  const SceneFile scene(scene_text);
  app::Inputs inputs;
  inputs.pipeline = pipeline_file(pipeline);
  inputs.scene = scene.path;
  inputs.share_memory = options.share_memory;
  inputs.repeats = options.decide_on_device ? "device" : "host";
  const app::Loaded loaded = app::load(inputs, "");
  execution::Execution execution(device(), loaded.plan, loaded.registry, {shader_folders(), false, false});
  execution.setup();
  for (int i = 0; i < steps; ++i) {
    execution.clock().dt = *loaded.problem->scene.time.dt;
    execution.step();
  }
  execution.check_faults();
  Run result;
  for (const graph::PlannedBuffer& buffer : loaded.plan.buffers)
    if (repeats(loaded.plan, buffer) && buffer.lifetime == graph::Lifetime::state && !buffer.texture &&
        !buffer.name.starts_with("repeat#"))
      result.state[buffer.name] = app::read_array(execution, buffer.name).packed;
  result.bytes = loaded.plan.bytes;
  for (const execution::RepeatTurns& repeat : execution.turns()) result.turns += repeat.turns;
  result.by_device =
      std::ranges::any_of(loaded.plan.stages, [](const graph::PlannedStage& stage) { return stage.spec.name == "repeat.until"; });
  return result;
}

std::string first_difference(const Run& one, const Run& other) {
  for (const auto& [name, bytes] : one.state)
    if (const auto same = other.state.find(name); same == other.state.end() || same->second != bytes) return name;
  return "";
}

}  // namespace

TEST_CASE("shared memory leaves the bytes of shipped pipelines as they are") {
  for (const std::string pipeline : {"mpm_snow", "mpm_thesis", "mpm_apic", "heightfield_contour", "heightfield_distance"}) {
    CAPTURE(pipeline);
    const bool particles = pipeline.starts_with("mpm");
    const int steps = particles ? 40 : 120;
    const Run own = run(pipeline, particles ? ball_text : field_text, steps, {});
    const Run shared = run(pipeline, particles ? ball_text : field_text, steps, {.share_memory = true});
    CHECK(own.state.size() > 10);
    CHECK(shared.bytes < own.bytes);
    CHECK(first_difference(own, shared) == "");
  }
}

TEST_CASE("repeats of shipped pipelines take the same turns to the same bytes by the host and by the device") {
  for (const std::string pipeline : {"heightfield_contour", "heightfield_distance"}) {
    CAPTURE(pipeline);
    const Run host = run(pipeline, field_text, 120, {});
    const Run device = run(pipeline, field_text, 120, {.decide_on_device = true});
    CHECK((device.by_device && !host.by_device));
    CHECK(host.turns == device.turns);
    CHECK((host.turns > 120 && host.turns < 4 * 120));  // some steps need one pass, some all four
    CHECK(first_difference(host, device) == "");
  }
}
