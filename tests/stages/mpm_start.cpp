// What stages put in place before the first step, and clear before every one.

#include "tests/stages/simulation.h"

using namespace firn::test;

TEST_CASE("clear_grid leaves nothing of what the sums held") {
  const RandomSnow snow(seed());
  StageRun run;
  run.stage = "mpm.clear_grid";
  run.environment = grid_environment(snow.setup());
  const auto nodes = static_cast<std::size_t>(snow.grid.count());
  run.in.integers = {{"grid_mass_sum", std::vector<std::int32_t>(nodes, 7)},
                     {"grid_momentum_sum", std::vector<std::int32_t>(3 * nodes, -7)},
                     {"grid_force_sum", std::vector<std::int32_t>(3 * nodes, 7)},
                     {"stress_max", {7}}};
  for (const auto& [name, values] : run_stage(run).integers) {
    INFO(name);
    CHECK(std::ranges::all_of(values, [](std::int32_t value) { return value == 0; }));
  }
}

TEST_CASE("seed and place give the scene's particles and bodies, in single precision") {
  const Simulation simulation("mpm_snow", R"(
firn: 1
name: start
time: {dt: 1.0e-4, end: 1}
domain: {min: [0, 0, 0], max: [1, 1, 1], cell: 0.0625}
materials: {ball: {density: 400, young: 1.4e5}}
snow: [{sphere: {center: [0.5, 0.5, 0.5], radius: 0.15}, material: ball, velocity: [1, 2, 3], spin: [0, 4, 0]}]
bodies:
  - {sphere: {radius: 0.1}, position: [0.2, 0.3, 0.4], velocity: [1, 0, 0], friction: 0.25}
  - {plane: {point: [0, 0.1, 0], normal: [1, 1, 0]}}
)");
  const firn::scene::Particles& particles = simulation.loaded.problem->particles;
  CHECK(simulation.floats("position") == flat(particles.position));
  CHECK(simulation.floats("velocity") == flat(particles.velocity));
  CHECK(simulation.floats("mass") == flat(particles.mass));
  CHECK(simulation.floats("elastic") == flat(std::vector<Matrix3d>(particles.mass.size(), Matrix3d::Identity())));
  CHECK(simulation.floats("plastic_det") == std::vector<float>(particles.mass.size(), 1.0f));
  CHECK(simulation.floats("body_position") == std::vector<float>{0.2f, 0.3f, 0.4f, 0, 0.1f, 0});
  CHECK(simulation.floats("body_velocity") == std::vector<float>{1, 0, 0, 0, 0, 0});
  CHECK(simulation.floats("body_friction") == std::vector<float>{0.25f, 0});
  const std::vector<float> turn = simulation.floats("body_orientation");
  const Vector3d normal = Eigen::Quaterniond(turn[7], turn[4], turn[5], turn[6]) * Vector3d::UnitY();
  CHECK((normal - Vector3d(1, 1, 0).normalized()).norm() <= 1e-6);
}
