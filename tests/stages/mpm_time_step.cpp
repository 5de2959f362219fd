// Steps of automatic length.

#include "app/simulation.h"
#include "tests/reference/time_step.h"
#include "tests/stages/simulation.h"

using namespace firn;
using namespace firn::test;

namespace {

constexpr double cfl = 0.3;

graph::Registry stages_for(const reference::Grid& grid) {
  scene::Scene scene;
  scene.time.dt.reset();
  scene.time.cfl = cfl;
  scene.domain.emplace().cell = grid.h;
  return stages::all_stages(std::make_shared<const stages::Problem>(stages::Problem{std::move(scene), {}, {}, {}, {}}));
}

}  // namespace

TEST_CASE("a step of automatic length is the reference's: by particles and pressure waves, in equal parts of what is left") {
  INFO("seed " << seed());
  reference::Random random(seed());
  for (int i = 0; i < 12; ++i) {
    RandomSnow snow(seed() + static_cast<std::uint64_t>(i), 300);
    // What moves most, and what waves are fastest in, in turn.
    const double size = i % 2 == 0 ? random.uniform(0, 1) : random.uniform(50, 500);
    for (Vector3d& v : snow.particles.velocity) v = single(random.vector(size));
    for (double& j : snow.particles.plastic_det) j = single(random.uniform(0.7, 1.1));
    // How far it goes by mpm.advect, from 0 in the middle of the grid, tells the length of the step.
    for (Vector3d& x : snow.particles.position) x = {0, 0, 0};
    snow.particles.velocity[0] = {1, 0, 0};
    GridSetup setup = snow.setup();
    for (std::size_t axis = 0; axis < 3; ++axis) setup.grid_min[axis] = -0.5 * snow.grid.h * setup.nodes[axis];
    graph::Environment environment = grid_environment(setup);
    environment.choices["time_step"] = "auto";
    const Arrays in = snow.arrays({"position", "velocity", "plastic_det", "material", "material_elastic"});
    for (const auto& [name, values] : in.floats) environment.provided.insert(name);
    for (const auto& [name, values] : in.integers) environment.provided.insert(name);

    const double speed = reference::fastest(snow.particles, snow.materials), longest = cfl * snow.grid.h / speed;
    const double left = longest * random.uniform(0.2, 6);
    const Arrays out =
        run_pipeline("firn: 1\nstep: [mpm.time_step, mpm.advect]\n", environment, stages_for(snow.grid), in, left, 1);
    float fastest = 0;
    std::memcpy(&fastest, out.integers.at("fastest").data(), sizeof fastest);
    CAPTURE(i, speed, left / longest);
    CHECK(fastest == Approx(speed).epsilon(1e-5));
    const double dt = out.floats.at("position")[0];
    CHECK(dt <= longest * (1 + 1e-5));
    const double parts = left / dt;
    CHECK(parts == Approx(std::round(parts)).epsilon(1e-6));
    // Single precision may find one part more or less where that is a close thing.
    const double close = left / longest;
    if (std::abs(close - std::round(close)) > 1e-4)
      CHECK(std::round(parts) == reference::steps_until(left, speed, cfl, snow.grid.h));
  }
}

TEST_CASE("steps of automatic length meet the times of frames exactly, whatever the snow does") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis");
  CAPTURE(pipeline);
  const SceneFile scene(R"(
firn: 1
name: fast_ball
time: {dt: auto, fps: 700, end: 1}
domain: {min: [0, 0, 0], max: [1, 1, 1], cell: 0.0625}
materials: {ball: {density: 400, young: 1.4e5}}
snow: [{sphere: {center: [0.5, 0.4, 0.5], radius: 0.15}, material: ball, velocity: [1, -9, 0.5]}]
bodies:
  - {plane: {point: [0, 0.2, 0], normal: [0, 1, 0]}, friction: 0.3}
)");
  app::Inputs inputs;
  inputs.pipeline = pipeline_file(pipeline);
  inputs.scene = scene.path;
  inputs.disable = {"render.shadow_map", "render.background", "render.particles", "io.frames", "io.video"};
  const app::Loaded loaded = app::load(inputs, "");
  execution::Execution execution(device(), loaded.plan, loaded.registry, {shader_folders(), false, false});
  const scene::Time& time = loaded.problem->scene.time;
  double before = 0;
  std::uint64_t frames = 1;
  int steps = 0;
  app::simulate(execution, time, {{}, 12}, true, [&](const graph::Clock& clock) {
    if (clock.step == 0) return;
    ++steps;
    CAPTURE(clock.step, clock.time);
    CHECK(clock.time > before);
    CHECK(clock.time <= static_cast<double>(frames) / time.fps + 1e-15);  // none leaps over a frame
    before = clock.time;
    if (clock.frame == frames) return;
    CHECK(std::abs(clock.time - static_cast<double>(frames) / time.fps) <= 1e-15);
    frames = clock.frame;
  });
  CHECK(frames == 12);
  CHECK(steps > 22);  // the ball and its waves allow no step as long as a frame
}
