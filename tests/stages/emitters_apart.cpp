// Several emitters and sinks in one scene: each keeps its own account, material and time.

#include <bit>

#include "scene/npy.h"
#include "tests/graph/folder.h"
#include "tests/stages/flow.h"

using namespace firn;
using namespace firn::test;

namespace {

// Of an account of two floats an entry.
double entry(const Flow& flow, const std::string& buffer, std::size_t number) {
  const std::vector<float> pairs = flow.floats(buffer);
  return static_cast<double>(pairs.at(2 * number)) + static_cast<double>(pairs.at(2 * number + 1));
}

// Two materials of which a particle weighs 1/64 kg and 1/32 kg; cells of 1/16 m, so that boxes and places are exact in binary.
std::string exact_scene(const std::string& more) {
  return "firn: 1\nname: apart\ntime: {dt: 2.0e-3, fps: 100, end: 1}\ngravity: [0, 0, 0]\n"
         "domain: {min: [0, 0, 0], max: [2, 2, 2], cell: 0.0625}\n"
         "materials:\n  light: {preset: new_snow, density: 100, young: 1.0e4}\n  heavy: {preset: packed, density: 300, young: "
         "1.0e4}\n" +
         more;
}

// Particles at rest, far from each other along x, each of one material.
struct Row {
  Row() {
    write("light.npy", 0.015625, {0.5F, 0.75F, 1.0F});
    write("heavy.npy", 0.03125, {1.25F, 1.5F});
  }
  void write(const std::string& name, double mass, const std::vector<float>& places) {
    std::vector<float> rows;
    for (const float x : places) rows.insert(rows.end(), {x, 1.0F, 1.0F});
    const std::string file = (folder.path() / name).string();
    scene::write_npy(file, {places.size(), 3}, std::span<const float>(rows));
    const std::string material = name.substr(0, name.find('.'));
    text += "  - {points: {file: " + file + ", mass: " + std::to_string(mass) + "}, material: " + material + "}\n";
  }
  Folder folder;
  std::string text = "snow:\n";
};

std::vector<float> places_along_x(const Flow& flow) {
  const std::vector<float> position = flow.floats("position");
  std::vector<float> places;
  for (std::size_t i = 0; i < position.size(); i += 3) places.push_back(position[i]);
  return places;
}

}  // namespace

TEST_CASE("each emitter keeps its own account and brings its own material") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis", "mpm_apic");
  CAPTURE(pipeline);
  const std::string two =
      "emitters:\n"
      "  - {snowfall: {center: [1, 1.5, 0.5], size: [0.5, 0.5], rate: 5, velocity: [0, -1, 0]}, material: light}\n"
      "  - {gun: {position: [0.5, 0.5, 1.5], direction: [1, 0, 0], speed: 2, radius: 0.1, rate: 2}, material: heavy, per_cell: 4}\n"
      "max_particles: 1000\n";
  Flow flow(pipeline, exact_scene(two));
  flow.frames(10);
  const scene::Scene& scene = flow.loaded.problem->scene;
  const std::vector<float> material = flow.floats("material"), mass = flow.floats("mass");
  std::array<std::size_t, 2> came{};
  for (std::size_t e = 0; e < 2; ++e) {
    CAPTURE(e);
    came.at(e) = scene::emitted_until(scene, scene.emitters[e], flow.execution->clock().time);
    const auto each = static_cast<float>(scene::particle_mass(scene, scene.emitters[e]));
    CHECK(came.at(e) > 10);
    CHECK(entry(flow, "emitted_mass", e) == static_cast<double>(came.at(e)) * static_cast<double>(each));
    std::size_t found = 0;
    for (std::size_t p = 0; p < mass.size(); ++p)
      found += std::bit_cast<std::int32_t>(material[p]) == scene.emitters[e].material && mass[p] == each ? 1 : 0;
    CHECK(found == came.at(e));
  }
  CHECK(came[0] + came[1] == flow.count());
}

TEST_CASE("each sink takes what lies in it or on its faces, while it is on, and keeps its own account") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis", "mpm_apic");
  CAPTURE(pipeline);
  const Row row;
  // The first is off by the first frame but one, the second is not on before, and the last one never is.
  Flow flow(pipeline, exact_scene(row.text + "sinks:\n"
                                             "  - {box: {min: [0.75, 0, 0], max: [1, 2, 2]}, until: 0.01}\n"
                                             "  - {box: {min: [1.375, 0, 0], max: [2, 2, 2]}, from: 0.01, until: 0.02}\n"
                                             "  - {box: {min: [0, 0, 0], max: [2, 2, 2]}, from: 0.9}\n"));
  const auto near = [&](const std::vector<float>& expected) {
    const std::vector<float> found = places_along_x(flow);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) CHECK(std::abs(found[i] - expected[i]) < 1e-3F);
  };
  near({0.5F, 1.25F, 1.5F});
  CHECK(entry(flow, "removed_mass", 0) == 0.03125);
  CHECK(entry(flow, "removed_mass", 1) == 0);
  flow.frames(1);
  near({0.5F, 1.25F});
  CHECK(entry(flow, "removed_mass", 0) == 0.03125);
  CHECK(entry(flow, "removed_mass", 1) == 0.03125);
  CHECK(entry(flow, "removed_mass", 2) == 0);
}

TEST_CASE("a sink that is no longer on takes nothing") {
  const Row row;
  Flow flow("mpm_snow",
            exact_scene(row.text + "sinks: [{box: {min: [1.0625, 0, 0], max: [2, 2, 2]}, from: 0.02, until: 0.03},\n"
                                   "        {box: {min: [0.25, 0, 0], max: [1.0625, 2, 2]}, until: 0.005}]\n"
                                   "emitters: [{gun: {position: [0.5, 0.5, 0.5], direction: [1, 0, 0], speed: 1, radius: "
                                   "0.1, rate: 2}, material: heavy}]\nmax_particles: 1000\n"));
  CHECK(flow.count() == 2);
  flow.frames(2);
  CHECK(entry(flow, "removed_mass", 0) == 0.0625);
  CHECK(entry(flow, "removed_mass", 1) == 0.046875);
  const std::uint64_t came = flow.count();
  CHECK(came > 0);
  flow.frames(1);
  CHECK(flow.count() > came);
  CHECK(entry(flow, "removed_mass", 1) == 0.046875);
}

TEST_CASE("what comes in the place of what has gone begins without its stress") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis", "mpm_apic");
  CAPTURE(pipeline);
  // All that there is goes at 0.05 s, under strain; new particles come with the frame after.
  const std::string strained =
      "snow: [{box: {min: [0.5, 0.5, 0.5], max: [1, 1, 1]}, material: heavy, per_cell: 8, spin: [0, 0, 6]}]\n"
      "sinks: [{box: {min: [0, 0, 0], max: [2, 2, 2]}, from: 0.05, until: 0.055}]\n"
      "emitters: [{gun: {position: [0.5, 0.5, 0.5], direction: [1, 0, 0], speed: 4, radius: 0.1, rate: 20}, material: heavy, from: "
      "0.055}]\nmax_particles: 10000\n";
  Flow flow(pipeline, exact_scene(strained));
  flow.frames(4);
  REQUIRE(flow.loaded.plan.buffer("stress") >= 0);
  CHECK(std::ranges::any_of(flow.floats("stress"), [](float part) { return part != 0; }));
  flow.frames(1);
  CHECK(flow.count() == 0);
  flow.frames(1);
  CHECK(flow.count() > 5);
  CHECK(std::ranges::all_of(flow.floats("stress"), [](float part) { return part == 0; }));
}

TEST_CASE("scales of fixed-point sums and the time step reckon with what emitters bring as with what lies there") {
  const std::string end =
      "time: {fps: 100, end: 1}\ndomain: {min: [0, 0, 0], max: [2, 2, 2], cell: 0.0625}\n"
      "materials:\n  heavy: {preset: packed, density: 300}\n";
  const std::string lies =
      "firn: 1\nname: lies\n" + end +
      "snow: [{box: {min: [0.5, 0.5, 0.5], max: [1, 1, 1]}, material: heavy, per_cell: 27, velocity: [0, -30, 0]}]\n";
  const std::string comes =
      "firn: 1\nname: comes\n" + end +
      "emitters: [{snowfall: {center: [1, 1, 1], size: [0.5, 0.5], rate: 5, velocity: [0, -30, 0]}, material: "
      "heavy, per_cell: 27}]\nmax_particles: 100000\n";
  const auto problem = [](const std::string& text) {
    const SceneFile scene(text);
    app::Inputs inputs;
    inputs.pipeline = pipeline_file("mpm_thesis");
    inputs.scene = scene.path;
    return app::load(inputs, "").problem;
  };
  const auto one = problem(lies), other = problem(comes);
  const auto constant = [](const stages::Problem& each, const std::string& name) {
    for (const graph::Constant& spec : stages::environment(each).constants)
      if (spec.name == name) return std::get<double>(spec.value);
    throw std::logic_error("no constant " + name);
  };
  for (const char* name : {"mass_scale", "momentum_scale", "crowd"}) {
    CAPTURE(name);
    CHECK(constant(*one, name) == constant(*other, name));
  }
  CHECK(stages::stable_time_step(other->scene) == Approx(stages::stable_time_step(one->scene)));
}
