#include "tests/reference/step.h"

#include "tests/catch.h"
#include "tests/reference/random.h"

using namespace firn::reference;

namespace {
// A ball of 8 particles per cell, jittered.
Particles ball(Random& random, const Vector3d& center, double radius, double h, const Vector3d& velocity, double density = 400) {
  Particles particles;
  const double spacing = h / 2, volume = spacing * spacing * spacing;
  const int n = static_cast<int>(radius / spacing) + 1;
  for (int k = -n; k <= n; ++k) {
    for (int j = -n; j <= n; ++j) {
      for (int i = -n; i <= n; ++i) {
        const Vector3d offset = spacing * Vector3d(i, j, k) + random.vector(spacing / 4);
        if (offset.norm() <= radius) particles.add(center + offset, velocity, density * volume, volume);
      }
    }
  }
  return particles;
}

Vector3d momentum(const Particles& particles) {
  Vector3d sum = Vector3d::Zero();
  for (int p = 0; p < particles.count(); ++p) sum += particles.mass[p] * particles.velocity[p];
  return sum;
}
}  // namespace

TEST_CASE("1000 steps of free fall are those of symplectic Euler, and leave the ball unstrained") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Grid grid{{-2, -8, -2}, 0.5, {9, 24, 9}};
  StepSettings settings;
  settings.dt = 1e-3;
  settings.kernel = GENERATE(Kernel::cubic, Kernel::quadratic);
  const Vector3d start(0.2, -0.3, 0.1);
  Particles particles = ball(random, {0, 2, 0}, 0.6, 0.5, start);
  const Particles before = particles;
  std::vector<Collider> none;
  const int steps = 1000;
  for (int i = 0; i < steps; ++i) step(particles, grid, {Material{}}, none, settings);
  const double t = steps * settings.dt;
  // y_n = y_0 + n dt v_0 + g dt^2 n (n + 1) / 2, which is g t^2 / 2 up to g t dt / 2.
  const Vector3d fall = t * start + settings.gravity * settings.dt * settings.dt * steps * (steps + 1) / 2;
  for (int p = 0; p < particles.count(); ++p) {
    CHECK((particles.position[p] - before.position[p] - fall).norm() < 1e-9);
    CHECK((particles.position[p] - before.position[p] - t * start - settings.gravity * t * t / 2).norm() < 9.81 * t * settings.dt);
    CHECK((particles.velocity[p] - start - t * settings.gravity).norm() < 1e-9);
    CHECK((particles.elastic[p] - Matrix3d::Identity()).norm() < 1e-9);
    CHECK(particles.plastic_det[p] == Approx(1));
  }
}

TEST_CASE("two balls that collide keep their momentum, and gravity adds exactly m g t") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Grid grid{{-1, -1, -1}, 0.1, {21, 21, 21}};
  Particles particles = ball(random, {-0.25, 0, 0}, 0.2, 0.1, {6, 0, 0});
  const Particles other = ball(random, {0.25, 0.05, 0}, 0.2, 0.1, {-5, 0, 0});
  for (int p = 0; p < other.count(); ++p) particles.add(other.position[p], other.velocity[p], other.mass[p], other.volume[p]);
  StepSettings settings;
  settings.dt = 2e-4;
  std::vector<Collider> none;
  const Vector3d before = momentum(particles);
  double mass = 0;
  for (const double m : particles.mass) mass += m;
  const int steps = 200;
  for (int i = 0; i < steps; ++i) {
    settings.measure_volume = i == 0;
    step(particles, grid, {Material{}}, none, settings);
  }
  CHECK((momentum(particles) - before - mass * steps * settings.dt * settings.gravity).norm() < 1e-9 * before.norm());
  double hardest = 1;
  for (const double j : particles.plastic_det) hardest = std::min(hardest, j);
  CHECK(hardest < 0.99);  // they did meet
}

TEST_CASE("the first step takes the volumes from the grid, later steps keep them") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Grid grid{{-1, -1, -1}, 0.1, {21, 21, 21}};
  Particles particles = ball(random, {0, 0, 0}, 0.2, 0.1, {0, 0, 0});
  const std::vector<double> given = particles.volume;
  std::vector<Collider> none;
  StepSettings settings;
  step(particles, grid, {Material{}}, none, settings);
  CHECK(particles.volume == given);
  settings.measure_volume = true;
  Particles again = ball(random, {0, 0, 0}, 0.2, 0.1, {0, 0, 0});
  Particles expected = again;
  initial_density(expected, particles_to_grid(expected, grid, Kernel::cubic), grid, Kernel::cubic);
  step(again, grid, {Material{}}, none, settings);
  CHECK(again.volume == expected.volume);
}

TEST_CASE("one step is its stages in the order of M2") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Grid grid{{-1, -1, -1}, 0.1, {21, 21, 21}};
  const std::vector<Material> materials{Material{}};
  StepSettings settings;
  settings.dt = 1e-3;
  Particles particles = ball(random, {0, 0, 0}, 0.2, 0.1, {1, -3, 0});
  for (int p = 0; p < particles.count(); ++p) particles.elastic[p] += random.matrix(0.01);
  Collider ball_below;
  ball_below.shape = Shape::sphere;
  ball_below.position = {0, -0.4, 0};
  ball_below.radius = 0.35;
  ball_below.velocity = {0.5, 0, 0};
  ball_below.spin = {0, 0, 1};
  ball_below.friction = 0.3;
  std::vector<Collider> colliders{ball_below}, moved{ball_below};

  Particles by_hand = particles;
  GridState state = particles_to_grid(by_hand, grid, settings.kernel);
  state.force = grid_forces(by_hand, stress(by_hand, materials), grid, settings.kernel);
  grid_update(state, settings.gravity, settings.dt);
  const std::vector<Vector3d> free_velocity = state.velocity;
  grid_collide(state, grid, colliders);
  CHECK(state.velocity != free_velocity);  // the case touches the collider
  const std::vector<Matrix3d> gradient = grid_to_particles(by_hand, state, grid, settings.kernel, settings.alpha);
  deform(by_hand, gradient, materials, settings.dt);
  for (int p = 0; p < by_hand.count(); ++p) {
    by_hand.velocity[p] = collide(by_hand.velocity[p], by_hand.position[p], colliders);
    by_hand.position[p] += settings.dt * by_hand.velocity[p];
  }
  const GridState used = step(particles, grid, materials, moved, settings);
  CHECK(used.velocity == state.velocity);
  CHECK(particles.position == by_hand.position);
  CHECK(particles.velocity == by_hand.velocity);
  CHECK(particles.elastic == by_hand.elastic);
  CHECK(particles.plastic_det == by_hand.plastic_det);
  CHECK((moved[0].position - Vector3d(0.5e-3, -0.4, 0)).norm() < 1e-15);
}

TEST_CASE("a ball that falls on the ground comes to rest on it") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Grid grid{{-1, -1, -1}, 0.1, {21, 21, 21}};
  Particles particles = ball(random, {0, 0.22, 0}, 0.2, 0.1, {0, -1, 0});
  Collider ground;
  ground.position = {0, 0.001, 0};
  ground.friction = 0.5;
  std::vector<Collider> colliders{ground};
  StepSettings settings;
  settings.dt = 5e-4;
  settings.alpha = 0.9;
  for (int i = 0; i < 1200; ++i) step(particles, grid, {Material{}}, colliders, settings);
  double lowest = 1, highest = 0, fastest = 0;
  for (int p = 0; p < particles.count(); ++p) {
    lowest = std::min(lowest, particles.position[p].y());
    highest = std::max(highest, particles.position[p].y());
    fastest = std::max(fastest, particles.velocity[p].norm());
  }
  CAPTURE(lowest, highest, fastest);
  CHECK(lowest > 0);
  CHECK(highest < 0.42);
  CHECK(fastest < 0.01);
}
