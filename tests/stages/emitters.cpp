// Particles that come and go: how many there are, what becomes of the others, and that nothing is paid where none do.

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "tests/stages/flow.h"

using namespace firn;
using namespace firn::test;

namespace {

std::vector<std::string> works_of(const graph::Plan& plan, const std::vector<graph::Op>& ops, bool with_barriers) {
  std::vector<std::string> lines;
  for (const graph::Op& op : ops) {
    if (const auto* barrier = std::get_if<graph::Barrier>(&op.what); barrier && with_barriers)
      lines.push_back(fmt::format("barrier {}", barrier->bits));
    if (const auto* run = std::get_if<graph::Run>(&op.what))
      lines.push_back(fmt::format("{} {}", plan.stages[static_cast<std::size_t>(run->stage)].label, run->work));
  }
  return lines;
}

graph::Plan whole_plan(const std::string& pipeline, const std::string& more) {
  const SceneFile scene(scene_text(more));
  app::Inputs inputs;
  inputs.pipeline = pipeline_file(pipeline);
  inputs.scene = scene.path;
  return app::load(inputs, "").plan;
}

}  // namespace

TEST_CASE("particles come at their rate in every pipeline, and their mass is all there, to the last digit") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis", "mpm_apic");
  CAPTURE(pipeline);
  Flow flow(pipeline, snow + emitters);
  const std::uint64_t first = flow.loaded.problem->particles.mass.size();
  const double mass_at_first = flow.total("mass");
  CHECK(flow.count() == first);
  for (int frame = 1; frame <= 12; ++frame) {
    flow.frames(1);
    CAPTURE(frame);
    CHECK(flow.count() == flow.due());
    CHECK(flow.floats("position").size() == 3 * flow.count());
    CHECK(flow.total("mass") == mass_at_first + flow.total("emitted_mass"));
  }
  CHECK(flow.count() == first + 154 + 70);
  // The newest, as they stand.
  const scene::Particles newest = scene::emitted(flow.loaded.problem->scene, 1, 153, 154, flow.execution->clock().time);
  const std::vector<float> position = flow.floats("position"), elastic = flow.floats("elastic"), volume = flow.floats("volume");
  CHECK(position[position.size() - 3] == static_cast<float>(newest.position[0].x()));
  CHECK(volume.back() == static_cast<float>(0.05 * 0.05 * 0.05 / 8));
  CHECK(std::vector<float>(elastic.end() - 9, elastic.end()) == std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  CHECK(flow.floats("plastic_det").back() == 1);
}

TEST_CASE("a stream is the same however coarse the frames are, but for what forces do") {
  // Without gravity and far from others a particle flies straight on.
  const std::string alone =
      "gravity: [0, 0, 0]\nemitters: [{snowfall: {center: [0.7, 0.5, 0.5], size: [0.4, 0.4], rate: 0.05, velocity: [0, -1, 0]}, "
      "material: light}]\nmax_particles: 100\n";
  Flow flow("mpm_snow", alone);
  flow.frames(30);
  const scene::Particles all = scene::emitted(flow.loaded.problem->scene, 0, 0, flow.count(), flow.execution->clock().time);
  REQUIRE(flow.count() > 1);
  const std::vector<float> position = flow.floats("position");
  for (std::size_t p = 0; p < flow.count(); ++p)
    for (std::size_t axis = 0; axis < 3; ++axis)
      CHECK(std::abs(static_cast<double>(position[3 * p + axis]) - all.position[p][static_cast<int>(axis)]) < 2e-5);
}

TEST_CASE("the same run brings the same particles, to the bit") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis", "mpm_apic");
  CAPTURE(pipeline);
  const std::string text = snow + emitters + "sinks: [{box: {min: [0.6, 0.1, 0], max: [1.5, 0.7, 1]}}]\n";
  Flow one(pipeline, text), other(pipeline, text);
  one.frames(20);
  other.frames(20);
  CHECK(one.count() == other.count());
  for (const auto& [name, bytes] : one.state()) {
    CAPTURE(name);
    const bool same = bytes == other.state().at(name);
    CHECK(same);
  }
}

TEST_CASE("sums as floats are no hindrance to coming and going") {
  Flow flow("mpm_thesis", snow + emitters + "sinks: [{box: {min: [0.6, 0.1, 0], max: [1.5, 0.7, 1]}}]\n", {"accumulate=float"});
  const double mass_at_first = flow.total("mass");
  flow.frames(20);
  CHECK(flow.total("removed_mass") > 0);
  CHECK(flow.total("mass") == mass_at_first + flow.total("emitted_mass") - flow.total("removed_mass"));
}

TEST_CASE("a sink empties its box and leaves the others as they were, in their order") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis", "mpm_apic");
  CAPTURE(pipeline);
  const std::string sink = "sinks: [{box: {min: [0.4, 0, 0], max: [0.5, 1, 0.6]}, from: 0.02}]\n";
  Flow without(pipeline, snow), with(pipeline, snow + sink);
  without.frames(1);
  with.frames(1);
  CHECK(with.count() == without.count());
  without.frames(1);
  with.frames(1);
  const std::vector<float> position = without.floats("position");
  std::vector<std::size_t> left;
  for (std::size_t p = 0; p < without.count(); ++p)
    if (position[3 * p] < 0.4F || position[3 * p] > 0.5F || position[3 * p + 2] > 0.6F) left.push_back(p);
  CHECK(left.size() < without.count() - 20);
  REQUIRE(with.count() == left.size());
  const auto before = without.state(), after = with.state();
  for (const char* name : {"position", "velocity", "mass", "volume", "elastic", "plastic_det", "material"}) {
    CAPTURE(name);
    const std::size_t size = before.at(name).size() / without.count();
    std::vector<std::byte> expected;
    for (const std::size_t p : left)
      expected.insert(expected.end(), before.at(name).begin() + static_cast<std::ptrdiff_t>(p * size),
                      before.at(name).begin() + static_cast<std::ptrdiff_t>((p + 1) * size));
    const bool same = after.at(name) == expected;
    CHECK(same);
  }
  CHECK(with.total("mass") == without.total("mass") - with.total("removed_mass"));
  with.frames(10);
  const std::vector<float> later = with.floats("position");
  for (std::size_t p = 0; p < with.count(); ++p)
    CHECK_FALSE((later[3 * p] > 0.4F && later[3 * p] < 0.5F && later[3 * p + 2] < 0.6F));
}

TEST_CASE("emitters stop at the declared maximum, and go on where a sink makes room") {
  const std::string few = std::string(emitters).replace(emitters.find("1000"), 4, "1100");
  Flow full("mpm_snow", snow + few);
  const std::uint64_t first = full.count();
  REQUIRE(first < 1100);
  full.frames(20);
  CHECK(full.due() > 1100);
  CHECK(full.count() == 1100);
  const double mass = full.total("mass");
  full.frames(3);
  CHECK(full.total("mass") == mass);
  // What there was no room for is not due any more.
  const std::vector<float> next = full.floats("emitter_next");
  for (std::size_t e = 0; e < 2; ++e)
    CHECK(std::bit_cast<std::uint32_t>(next.at(e)) ==
          scene::emitted_until(full.loaded.problem->scene, full.loaded.problem->scene.emitters[e], full.execution->clock().time));

  Flow open("mpm_snow", snow + few + "sinks: [{box: {min: [0.2, 0, 0], max: [0.6, 0.5, 1]}, from: 0.2}]\n");
  open.frames(19);
  CHECK(open.count() == 1100);
  open.frames(1);
  CHECK(open.total("removed_mass") > 0);
  CHECK(open.total("mass") ==
        Approx(mass - open.total("removed_mass") + (open.total("emitted_mass") - full.total("emitted_mass"))));
  open.frames(5);
  CHECK(open.total("emitted_mass") > full.total("emitted_mass"));
}

TEST_CASE("an emitter that is idle changes neither a byte nor a dispatch") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis", "mpm_apic");
  CAPTURE(pipeline);
  const std::string idle =
      "emitters:\n"
      "  - {snowfall: {center: [0.8, 0.8, 0.5], size: [0.5, 0.4], rate: 0, velocity: [0, -1, 0]}, material: light}\n"
      "  - {snowfall: {center: [0.8, 0.8, 0.5], size: [0.5, 0.4], rate: 5, velocity: [0, -1, 0]}, material: light, from: 0.9}\n"
      "max_particles: 5000\n";
  // As fast as the emitters: the scales of fixed-point sums follow the fastest, and must be the same.
  const std::string lump =
      "snow: [{box: {min: [0.3, 0.2, 0.3], max: [0.5, 0.35, 0.7]}, material: light, per_cell: 8, velocity: [0, -1, 0]}]\n";
  Flow without(pipeline, lump), with(pipeline, lump + idle);
  const graph::Plan plan_without = whole_plan(pipeline, lump), plan_with = whole_plan(pipeline, lump + idle);
  CHECK(works_of(plan_with, plan_with.step, true) == works_of(plan_without, plan_without.step, true));
  std::vector<std::string> frame = works_of(plan_without, plan_without.frame, false);
  frame.insert(frame.begin(), "mpm.emit 0");
  CHECK(works_of(plan_with, plan_with.frame, false) == frame);
  without.frames(10);
  with.frames(10);
  CHECK(with.count() == without.count());
  for (const auto& [name, bytes] : without.state()) {
    CAPTURE(name);
    const bool same = bytes == with.state().at(name);
    CHECK(same);
  }
}

TEST_CASE("a run may begin without a particle, and end without one") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis", "mpm_apic");
  CAPTURE(pipeline);
  Flow flow(pipeline, std::string(emitters) + "sinks: [{box: {min: [0, 0, 0], max: [1.5, 1, 1]}, from: 0.06}]\n");
  CHECK(flow.count() == 0);
  flow.frames(4);
  CHECK(flow.count() == flow.due());
  CHECK(flow.count() > 50);
  flow.frames(4);
  CHECK(flow.count() < 30);
  CHECK(flow.total("mass") == flow.total("emitted_mass") - flow.total("removed_mass"));
}

TEST_CASE("emitters and sinks are told of where the pipeline has no stage for them") {
  app::Inputs inputs;
  const SceneFile scene(scene_text(snow + emitters + "sinks: [{box: {min: [0.4, 0, 0], max: [0.5, 1, 0.6]}}]\n"));
  inputs.pipeline = pipeline_file("mpm_snow");
  inputs.scene = scene.path;
  inputs.disable = {"mpm.emit", "mpm.remove"};
  std::string text;
  const app::Loaded loaded = app::load(inputs, "");
  for (const config::Diagnostic& each : loaded.diagnostics.all()) text += config::to_string(each) + "\n";
  INFO(text);
  CHECK(text.find("emitters do nothing in this pipeline: it has no stage mpm.emit") != std::string::npos);
  CHECK(text.find("sinks do nothing in this pipeline: it has no stage mpm.remove") != std::string::npos);
}
