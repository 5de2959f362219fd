// APIC with MLS-MPM on stored blocks: its stages against the double-precision references, its pipeline against mechanics.

#include "tests/reference/affine.h"
#include "tests/stages/simulation.h"
#include "tests/stages/stored_blocks.h"

using namespace firn::test;
namespace ref = firn::reference;

namespace {

const std::string gather = "  - mpm.sort: {nodes: active}\n  - mpm.gather_affine\n";
const char* const back = "  - mpm.grid_to_particles_affine\n";

Arrays inputs(const RandomSnow& snow) {
  Arrays in = snow.arrays({"position", "velocity", "mass", "velocity_gradient"});
  in.floats["stress"] = flat(symmetric_stress(snow));
  return in;
}

ref::GridState solved(const RandomSnow& snow) {
  return ref::affine_to_grid(snow.particles, snow.gradient, symmetric_stress(snow), snow.grid, Vector3d(0, -9.81, 0), block_dt);
}

// Particles of a simulation; C_p where its pipeline has one, else nothing.
struct Motion {
  explicit Motion(const Simulation& simulation, bool affine = true) {
    const std::vector<float> mass = simulation.floats("mass");
    particles.mass = {mass.begin(), mass.end()};
    particles.position = simulation.vectors("position");
    particles.velocity = simulation.vectors("velocity");
    gradient.assign(mass.size(), Matrix3d::Zero());
    const std::vector<float> values = affine ? simulation.floats("velocity_gradient") : std::vector<float>();
    for (std::size_t i = 0; i < values.size(); ++i)
      gradient[i / 9](static_cast<int>(i % 9 / 3), static_cast<int>(i % 3)) = static_cast<double>(values[i]);
  }
  [[nodiscard]] Vector3d angular_momentum(double cell) const {
    ref::Grid grid;
    grid.h = cell;
    return ref::angular_momentum(particles, gradient, grid);
  }
  ref::Particles particles;
  std::vector<Matrix3d> gradient;
};

}  // namespace

TEST_CASE("gather_affine gives the reference's mass and momentum of nodes, and gravity's share") {
  INFO("seed " << seed());
  const RandomSnow snow = lumps(seed(), 1500);
  const Arrays out = run(snow, gather, inputs(snow), 2);
  const ref::GridState expected = solved(snow);
  const std::vector<float> mass = flat(expected.mass);
  CHECK(relative_error(whole(out, "grid_mass", snow.grid.nodes), mass) <= 1e-5);
  // Velocities where hardly any mass is are as inexact as that mass; what acts on particles is the product.
  const auto momentum = [&](std::vector<float> velocity) {
    for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] *= mass[i / 3];
    return velocity;
  };
  CHECK(relative_error(momentum(whole(out, "grid_velocity", snow.grid.nodes)), momentum(flat(expected.velocity))) <= 1e-5);
}

TEST_CASE("grid_to_particles_affine gives the reference's velocities and affine parts") {
  INFO("seed " << seed());
  const RandomSnow snow = lumps(seed(), 1500);
  const Arrays out = run(snow, gather + back, inputs(snow));
  // From the velocities that the device had on its nodes: this is about one stage.
  ref::GridState grid;
  const std::vector<float> nodes = whole(out, "grid_velocity", snow.grid.nodes);
  for (std::size_t i = 0; i < nodes.size(); i += 3) grid.velocity.emplace_back(nodes[i], nodes[i + 1], nodes[i + 2]);
  ref::Particles expected = snow.particles;
  const std::vector<Matrix3d> affine = ref::grid_to_particles_affine(expected, grid, snow.grid);
  CHECK(relative_error(out.floats.at("velocity"), flat(expected.velocity)) <= 1e-5);
  CHECK(relative_error(out.floats.at("velocity_gradient"), flat(affine)) <= 1e-5);
}

TEST_CASE("affine transfers with bodies between them do what the references do") {
  INFO("seed " << seed());
  RandomSnow snow = lumps(seed(), 1500);
  for (ref::Collider& c : snow.colliders) c.position = single(Vector3d(c.position + snow.grid.h * Vector3d(33, 18, 0)));
  Arrays in = inputs(snow);
  const Arrays bodies =
      snow.arrays({"body_kind", "body_size", "body_position", "body_orientation", "body_velocity", "body_spin", "body_friction"});
  in.floats.insert(bodies.floats.begin(), bodies.floats.end());
  in.integers.insert(bodies.integers.begin(), bodies.integers.end());
  const Arrays out = run(snow, gather + "  - mpm.grid_collide: {nodes: active}\n" + back, in);
  ref::GridState grid = solved(snow);
  ref::grid_collide(grid, snow.grid, snow.colliders);
  ref::Particles expected = snow.particles;
  const std::vector<Matrix3d> affine = ref::grid_to_particles_affine(expected, grid, snow.grid);
  CHECK(relative_error(out.floats.at("velocity"), flat(expected.velocity)) <= 2e-5);
  CHECK(relative_error(out.floats.at("velocity_gradient"), flat(affine)) <= 2e-5);
}

TEST_CASE("a spinning block keeps its angular momentum to 1e-4 over 100 steps by APIC, and not by PIC") {
  const char* const scene = R"(
firn: 1
name: spin
gravity: [0, 0, 0]
time: {dt: 2.0e-4, end: 1}
domain: {min: [0, 0, 0], max: [1, 1, 1], cell: 0.0625}
materials: {block: {density: 400, young: 1.4e5}}
snow: [{box: {min: [0.3, 0.35, 0.4], max: [0.7, 0.65, 0.6]}, material: block, spin: [1, 2, 10]}]
)";
  const auto drift = [&](const char* pipeline, const std::vector<std::string>& set, bool affine) {
    Simulation simulation(pipeline, scene, set);
    const Vector3d before = Motion(simulation, affine).angular_momentum(0.0625);
    simulation.steps(100);
    return (Motion(simulation, affine).angular_momentum(0.0625) - before).norm() / before.norm();
  };
  const double apic = drift("mpm_apic", {}, true);
  const double pic = drift("mpm_snow", {"kernel=quadratic", "mpm.grid_to_particles.flip=0"}, false);
  CAPTURE(apic, pic);
  CHECK(apic <= 1e-4);
  CHECK(pic >= 0.1);
}

TEST_CASE("two balls that collide by APIC keep momentum and angular momentum") {
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
  Simulation simulation("mpm_apic", scene);
  const Vector3d linear = simulation.momentum(), angular = Motion(simulation).angular_momentum(0.125);
  simulation.steps(500);
  const double hardest = std::ranges::min(simulation.floats("plastic_det"));
  const double linear_drift = (simulation.momentum() - linear).norm() / linear.norm();
  const double angular_drift = (Motion(simulation).angular_momentum(0.125) - angular).norm() / angular.norm();
  CAPTURE(linear_drift, angular_drift, hardest);
  CHECK(hardest < 0.99);  // they did meet
  CHECK(linear_drift <= 1e-5);
  CHECK(angular_drift <= 1e-4);
}

TEST_CASE("free fall by APIC matches g t^2 over 2 to 1e-4, and nothing turns or is strained") {
  const char* const scene = R"(
firn: 1
name: fall
time: {dt: 4.0e-4, end: 1}
domain: {min: [0, 0, 0], max: [1, 2, 1], cell: 0.0625}
materials: {ball: {density: 400, young: 1.4e5}}
snow: [{sphere: {center: [0.5, 1.6, 0.5], radius: 0.15}, material: ball}]
)";
  Simulation simulation("mpm_apic", scene);
  const std::vector<Vector3d> before = simulation.vectors("position");
  constexpr int steps = 1000;
  simulation.steps(steps);
  // The scheme's own sum: 1/n more than g t^2 / 2.
  const double scheme = 9.81 * 16e-8 * steps * (steps + 1) / 2;
  const std::vector<Vector3d> after = simulation.vectors("position");
  for (std::size_t p = 0; p < before.size(); ++p) REQUIRE((after[p] - before[p] + Vector3d(0, scheme, 0)).norm() <= 1e-4 * scheme);
  for (const float c : simulation.floats("velocity_gradient")) REQUIRE(std::abs(c) <= 1e-3);
}

TEST_CASE("a ball that hits a plane by APIC comes to rest on it and keeps together") {
  const char* const scene = R"(
firn: 1
name: rest
time: {dt: 5.0e-4, end: 2}
domain: {min: [0, 0, 0], max: [2, 1.5, 2], cell: 0.1}
materials: {ball: {density: 400, young: 1.4e5}}
snow: [{sphere: {center: [1, 0.6, 1], radius: 0.25}, material: ball, velocity: [0, -1, 0]}]
bodies: [{plane: {point: [0, 0.3, 0], normal: [0, 1, 0]}, friction: 0.5}]
)";
  Simulation simulation("mpm_apic", scene);
  simulation.steps(2000);
  double lowest = 9, highest = 0, fastest = 0, farthest = 0;
  for (const Vector3d& x : simulation.vectors("position")) {
    lowest = std::min(lowest, x.y());
    highest = std::max(highest, x.y());
    farthest = std::max(farthest, std::hypot(x.x() - 1, x.z() - 1));
  }
  for (const Vector3d& v : simulation.vectors("velocity")) fastest = std::max(fastest, v.norm());
  CAPTURE(lowest, highest, fastest, farthest);
  CHECK(lowest > 0.29);
  CHECK(lowest < 0.35);
  CHECK(highest > 0.6);  // not flat
  CHECK(highest < 0.85);
  CHECK(farthest < 0.4);
  CHECK(fastest < 0.02);
}
