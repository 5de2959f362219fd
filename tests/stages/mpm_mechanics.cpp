// The shipped pipelines against mechanics.

#include "tests/stages/simulation.h"

using namespace firn::test;

namespace {

Vector3d mean(const std::vector<Vector3d>& values) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

}  // namespace

TEST_CASE("momentum without gravity and bodies is kept to 1e-5 over 1,000 steps") {
  const char* const scene = R"(
firn: 1
name: drift
gravity: [0, 0, 0]
time: {dt: 2.0e-4, end: 1}
domain: {min: [0, 0, 0], max: [2, 2, 2], cell: 0.125}
materials: {ball: {density: 400, young: 1.4e5}}
snow:
  - {sphere: {center: [0.6, 0.9, 1], radius: 0.24}, material: ball, velocity: [3, 0.5, -0.25], spin: [0, 0, 6]}
  - {sphere: {center: [1.2, 0.95, 1], radius: 0.24}, material: ball, velocity: [-1, 0.25, 0]}
)";
  for (const Variant& variant : variants) {
    CAPTURE(variant.pipeline, variant.accumulate);
    Simulation simulation(variant.pipeline, scene, settings(variant));
    const Vector3d before = simulation.momentum();
    simulation.steps(1000);
    const double drift = (simulation.momentum() - before).norm() / before.norm();
    CAPTURE(drift);
    CHECK(drift <= 1e-5);
  }
}

TEST_CASE("free fall matches g t^2 / 2 to 1e-4") {
  const char* const scene = R"(
firn: 1
name: fall
time: {dt: 1.0e-4, end: 1}
domain: {min: [0, 0, 0], max: [1, 2, 1], cell: 0.0625}
materials: {ball: {density: 400, young: 1.4e5}}
snow: [{sphere: {center: [0.5, 1.6, 0.5], radius: 0.15}, material: ball}]
)";
  for (const char* pipeline : {"mpm_thesis", "mpm_snow"}) {
    CAPTURE(pipeline);
    Simulation simulation(pipeline, scene);
    const double before = mean(simulation.vectors("position")).y();
    constexpr int steps = 4000;
    simulation.steps(steps);
    const double t = steps * 1e-4, fallen = before - mean(simulation.vectors("position")).y();
    // The scheme's own sum is g dt^2 n (n + 1) / 2: 1/n more than g t^2 / 2, which is 2.5e-4 here and belongs to the method.
    const double scheme = 9.81 * 1e-8 * steps * (steps + 1) / 2;
    CAPTURE(fallen, scheme);
    CHECK(std::abs(fallen / scheme - 1) <= 1e-4);
    CHECK(std::abs(fallen / (0.5 * 9.81 * t * t) - 1) <= 1e-4 + 1.0 / steps);
  }
}

TEST_CASE("a block on a slope slides with g (sin a - mu cos a), and rests above the friction angle") {
  // The axes are turned with the slope of 30 degrees: gravity is tilted, the plane lies on grid planes.
  const char* const scene = R"(
firn: 1
name: slope
time: {dt: 2.0e-4, end: 1}
gravity: [4.905, -8.4957, 0]
domain: {min: [0, 0, 0], max: [2, 1, 1], cell: 0.0625}
materials: {block: {density: 400, young: 1.0e6, poisson: 0.2, hardening: 10, critical_compression: 0.4, critical_stretch: 0.4}}
snow: [{box: {min: [0.4, 0.25, 0.3], max: [0.8, 0.5, 0.7]}, material: block}]
bodies: [{plane: {point: [0, 0.25, 0], normal: [0, 1, 0]}, friction: 0.2}]
)";
  const auto acceleration = [&](const char* friction) {
    Simulation simulation("mpm_snow", scene, {std::string("scene.bodies.0.friction=") + friction});
    simulation.steps(500);  // settled on the plane
    const double before = mean(simulation.vectors("velocity")).x();
    simulation.steps(1000);
    return (mean(simulation.vectors("velocity")).x() - before) / 0.2;
  };
  CHECK(acceleration("0.2") == Approx(4.905 - 0.2 * 8.4957).epsilon(0.02));
  CHECK(acceleration("0.4") == Approx(4.905 - 0.4 * 8.4957).epsilon(0.02));
  CHECK(std::abs(acceleration("0.7")) <= 0.02);
}
