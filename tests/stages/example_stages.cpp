// The stages under pipelines/examples/, which are shaders with their specs at their heads, in their own pipelines.

#include <cmath>

#include "gpu/program.h"
#include "tests/stages/field_simulation.h"

using namespace firn;
using namespace firn::test;

namespace {

std::string field_scene(const std::string& field) {
  return "firn: 1\nname: examples\ntime: {dt: 1.0e-2, end: 1}\nmaterials: {snow: {preset: settled, min_density: 80}}\nfield: "
         "{size: [4, 4], cells: "
         "[40, 40], material: snow, density: 200, " +
         field + "}\n";
}

constexpr const char* falling_ball =
    "firn: 1\nname: fall\nseed: 2\ntime: {dt: 1.0e-4, end: 1}\ngravity: [0, 0, 0]\ndomain: {min: [0, 0, 0], max: [1, 1, 1], cell: "
    "0.05}\nmaterials: {ball: {preset: packed}}\nsnow:\n  - {sphere: {center: [0.5, 0.5, 0.5], radius: 0.15}, material: ball, "
    "velocity: [1, -2, 0.5], per_cell: 4}\n";

// Of snow, per area, over all cells, kg/m2.
double snow(const FieldState& field) { return field.mass() / (field.h * field.h); }

// A folder for a stage's file and what it includes.
struct StageFolder {
  StageFolder() { std::filesystem::create_directories(path); }
  ~StageFolder() { std::filesystem::remove_all(path); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("firn-stage-" + std::to_string(getpid()));
};

std::string doubling(const std::string& body) {
  return "/*\nfirn: 1\nname: doubling\ndoc: Doubles\nports:\n  x: {type: float, domain: cells, access: read_write, unit: m, doc: "
         "a port}\nover: cells\n*/\n" +
         body;
}

Arrays run_file(const StageFolder& folder) {
  graph::Environment environment;
  environment.domains = {{"cells", {6, 3, 2}}};
  environment.provided = {"x"};
  return run_pipeline("firn: 1\nstep:\n  - " + (folder.path / "double.comp").string() + "\n", environment, graph::Registry{},
                      {.floats = {{"x", {0, 1, 2, 3, 4, 5}}}, .integers = {}}, 0, 1);
}

}  // namespace

TEST_CASE("a stage's file includes what lies beside it, and Firn's own shaders") {
  const StageFolder folder;
  folder.write("twice.glsl", "float twice(float value) { return 2.0 * value; }\n");
  folder.write("double.comp",
               doubling("#include \"lib/cells.glsl\"\n#include \"twice.glsl\"\nvoid main() {\n  if (element_index() < "
                        "cells_count) x[cell_index(cell_at(element_index()))] = twice(x[element_index()]);\n}\n"));
  CHECK(run_file(folder).floats.at("x") == std::vector<float>{0, 2, 4, 6, 8, 10});
}

TEST_CASE("an error of GLSL in a stage's file is told with the file's own name and line") {
  const StageFolder folder;
  folder.write("double.comp", doubling("void main() { x[0] = wrong; }\n"));
  std::string message;
  try {
    run_file(folder);
  } catch (const config::InputError& error) {
    message = error.what();
  }
  INFO(message);
  CHECK(message.find("double.comp:9: error:") != std::string::npos);
}

TEST_CASE("velocity damping takes exp of minus rate times time of the momentum, and no mass") {
  constexpr double rate = 20;
  constexpr int steps = 50;
  Simulation simulation("examples/velocity_damping", falling_ball, {"rate=20"});
  const Vector3d before = simulation.momentum();
  const std::vector<float> mass = simulation.floats("mass");
  simulation.steps(steps);
  const Vector3d expected = before * std::exp(-rate * steps * 1e-4);
  CHECK((simulation.momentum() - expected).norm() < 2e-4 * expected.norm());
  CHECK(simulation.floats("mass") == mass);
}

TEST_CASE("without damping the pipeline of the example is the shipped one, to the bit") {
  Simulation damped("examples/velocity_damping", falling_ball, {"rate=0"});
  damped.steps(10);
  Simulation shipped("mpm_snow", falling_ball);
  shipped.steps(10);
  CHECK(damped.floats("position") == shipped.floats("position"));
  CHECK(damped.floats("velocity") == shipped.floats("velocity"));
}

TEST_CASE("wind drift carries snow downwind and keeps its mass and volume") {
  Simulation simulation("examples/wind_drift", field_scene("depth: 0.4"), {"wind=[1, 0, 0]", "erosion=5"});
  const FieldState before = field_state(simulation);
  simulation.steps(40);
  const FieldState after = field_state(simulation);
  CHECK(snow(after) == Approx(snow(before)).epsilon(1e-6));
  double volume_before = 0, volume_after = 0;
  for (std::size_t i = 0; i < after.depth.size(); ++i) {
    volume_before += static_cast<double>(before.depth[i]);
    volume_after += static_cast<double>(after.depth[i]);
    CHECK(std::isfinite(after.depth[i]));
  }
  CHECK(volume_after == Approx(volume_before).epsilon(1e-6));
  // Away from the edges as much comes as goes; the first column gives without getting, the last gets without giving. Two uses of
  // the stage are two steps of the wind: 2 * 40 * dt * erosion / density.
  const double moved = 2 * 40 * 1e-2 * 5 / 200;
  CHECK(after.depth[after.at(20, 20)] == Approx(before.depth[before.at(20, 20)]).epsilon(1e-4));
  CHECK(after.depth[after.at(20, 0)] < before.depth[before.at(20, 0)] - 0.5f * static_cast<float>(moved));
  CHECK(after.depth[after.at(20, 39)] > before.depth[before.at(20, 39)]);
  CHECK(after.depth[after.at(20, 0)] == Approx(after.depth[after.at(5, 0)]).epsilon(1e-5));  // the wind has no side to it
}

TEST_CASE("wind drift leaves in the lee what it brings there, and takes nothing from it") {
  graph::Environment environment;
  environment.domains = {{"cells", {6, 6, 1}}};
  environment.constants = {{"field_cell", graph::ElementType::float1, 1.0, "m", ""}};
  environment.provided = {"ground", "depth", "density", "drifted_depth", "drifted_density"};
  // A wall of snow 2 m high, and wind over it along x; 5 kg/m2 are 25 mm of snow.
  const Arrays in{.floats = {{"ground", std::vector<float>(6, 0.0f)},
                             {"depth", {2, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f}},
                             {"density", std::vector<float>(6, 200.0f)}},
                  .integers = {}};
  const Arrays out =
      run_pipeline(std::string("firn: 1\nstep:\n  - ") + FIRN_SOURCE_DIR + "/pipelines/examples/wind_drift.comp: {erosion: 5}\n",
                   environment, graph::Registry{}, in, 1, 1);
  const std::vector<double> expected{1.975, 0.525, 0.475, 0.5, 0.5, 0.525};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CAPTURE(i);
    CHECK(out.floats.at("drifted_depth")[i] == Approx(expected[i]));
    CHECK(out.floats.at("drifted_density")[i] == Approx(200));
  }
}

TEST_CASE("wind drift takes nothing without wind, and never more than there is") {
  const auto after = [](const std::string& field, std::vector<std::string> set) {
    Simulation simulation("examples/wind_drift", field_scene(field), std::move(set));
    simulation.steps(20);
    return field_state(simulation);
  };
  const FieldState still = after("depth: 0.4", {"wind=[0, 1, 0]"});
  for (const float depth : still.depth) CHECK(depth == 0.4f);
  const FieldState storm = after("depth: 0.01", {"wind=[-1, 0, 1]", "erosion=1000"});
  CHECK(snow(storm) == Approx(0.01 * 200 * 1600).epsilon(1e-5));
  for (const float depth : storm.depth) CHECK(depth >= 0.0f);
}

TEST_CASE("melt takes what the degree-day method says, and counts the water that runs off") {
  // factor 4 kg/m2/K/day, 5 degrees, a day per second: 20 kg/m2/s
  Simulation simulation("examples/melt", field_scene("depth: 0.4"));
  const FieldState before = field_state(simulation);
  simulation.steps(50);
  const FieldState after = field_state(simulation);
  const std::vector<float> melted = simulation.floats("melted");
  const double air = 5 - 6.5e-3 * 0.4;
  for (std::size_t i = 0; i < after.depth.size(); ++i) {
    CHECK(melted[i] == Approx(4 * air * 0.5).epsilon(1e-3));
    CHECK(after.depth[i] * after.density[i] + melted[i] == Approx(before.depth[i] * before.density[i]).epsilon(1e-5));
    CHECK(after.density[i] == before.density[i]);
  }
}

TEST_CASE("melt leaves snow alone in frost, and stops where none is left") {
  Simulation frost("examples/melt", field_scene("depth: 0.4"), {"temperature=-1"});
  frost.steps(20);
  for (const float depth : frost.floats("depth")) CHECK(depth == 0.4f);
  Simulation heat("examples/melt", field_scene("depth: 0.05"), {"temperature=50"});
  heat.steps(100);
  for (const float depth : heat.floats("depth")) CHECK(depth == 0.0f);
  for (const float melted : heat.floats("melted")) CHECK(melted == Approx(0.05 * 200).epsilon(1e-5));
}

TEST_CASE("melt is weaker higher up, by the lapse of the air's temperature") {
  Simulation simulation("examples/melt", field_scene("depth: 0.4, ground: 500"));
  simulation.steps(10);
  for (const float melted : simulation.floats("melted")) CHECK(melted == Approx(4 * (5 - 6.5e-3 * 500.4) * 0.1).epsilon(1e-3));
}
