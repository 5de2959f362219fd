#include "tests/reference/transfers.h"

#include "tests/catch.h"
#include "tests/reference/material.h"
#include "tests/reference/random.h"

using namespace firn::reference;

namespace {
const Grid kGrid{{-0.2, 0.1, 0.3}, 0.1, {9, 8, 10}};
const std::vector<Material> kMaterials{Material{}, Material{8e5, 0.3, 5, 2e-2, 5e-3, 300}};

// A cloud of strained particles inside the grid.
Particles cloud(Random& random, int count) {
  Particles particles;
  for (int p = 0; p < count; ++p) {
    const Vector3d u(random.uniform(1.1, 5.9), random.uniform(1.1, 4.9), random.uniform(1.1, 6.9));
    particles.add(kGrid.min + kGrid.h * u, random.vector(4), random.uniform(0.02, 0.06), random.uniform(1e-4, 2e-4), p % 2);
    particles.elastic.back() = random.rotation() * (Matrix3d::Identity() + random.matrix(0.1));
    particles.plastic_det.back() = random.uniform(0.9, 1.05);
  }
  return particles;
}

Vector3d momentum(const Particles& particles) {
  Vector3d sum = Vector3d::Zero();
  for (int p = 0; p < particles.count(); ++p) sum += particles.mass[p] * particles.velocity[p];
  return sum;
}
}  // namespace

TEST_CASE("the grid holds the particles' mass, momentum and centre of mass") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Kernel kernel = GENERATE(Kernel::cubic, Kernel::quadratic);
  const Particles particles = cloud(random, 60);
  const GridState state = particles_to_grid(particles, kGrid, kernel);
  double grid_mass = 0, mass = 0;
  Vector3d grid_momentum = Vector3d::Zero(), center = Vector3d::Zero();
  for (int i = 0; i < kGrid.count(); ++i) {
    grid_mass += state.mass[i];
    grid_momentum += state.momentum[i];
    center += state.mass[i] * kGrid.position(i);
  }
  for (int p = 0; p < particles.count(); ++p) {
    mass += particles.mass[p];
    center -= particles.mass[p] * particles.position[p];
  }
  CHECK(grid_mass == Approx(mass).epsilon(1e-13));
  CHECK((grid_momentum - momentum(particles)).norm() < 1e-12);
  CHECK(center.norm() < 1e-13);
}

TEST_CASE("a full lattice of particles has the density of its mass per volume, and the volumes of its cells") {
  const Kernel kernel = GENERATE(Kernel::cubic, Kernel::quadratic);
  Grid grid{{0, 0, 0}, 0.1, {14, 14, 14}};
  Particles particles;
  const double spacing = grid.h / 2, density = 400, mass = density * spacing * spacing * spacing;
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 20; ++j) {
      for (int i = 0; i < 20; ++i) {
        particles.add(Vector3d::Constant(0.1625) + spacing * Vector3d(i, j, k), {0, 0, 0}, mass, 0);
      }
    }
  }
  const GridState state = particles_to_grid(particles, grid, kernel);
  const std::vector<double> found = initial_density(particles, state, grid, kernel);
  const int middle = 10 + 20 * (10 + 20 * 10);
  CHECK(found[middle] == Approx(density).epsilon(1e-12));
  CHECK(particles.volume[middle] == Approx(spacing * spacing * spacing).epsilon(1e-12));
  CHECK(found[0] < 0.5 * density);  // a corner
  for (int p = 0; p < particles.count(); p += 97) CHECK(particles.volume[p] * found[p] == Approx(mass));
}

TEST_CASE("inner forces sum to zero and turn nothing") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Kernel kernel = GENERATE(Kernel::cubic, Kernel::quadratic);
  const Particles particles = cloud(random, 40);
  const std::vector<Vector3d> force = grid_forces(particles, stress(particles, kMaterials), kGrid, kernel);
  Vector3d sum = Vector3d::Zero(), torque = Vector3d::Zero();
  double largest = 0;
  for (int i = 0; i < kGrid.count(); ++i) {
    sum += force[i];
    torque += kGrid.position(i).cross(force[i]);
    largest = std::max(largest, force[i].norm());
  }
  CHECK(largest > 1);
  CHECK(sum.norm() < 1e-12 * largest * kGrid.count());
  CHECK(torque.norm() < 1e-12 * largest * kGrid.count());
}

TEST_CASE("the force on a node is minus the derivative of the elastic energy by the node's position") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Kernel kernel = GENERATE(Kernel::cubic, Kernel::quadratic);
  const Particles particles = cloud(random, 4);
  const std::vector<Vector3d> force = grid_forces(particles, stress(particles, kMaterials), kGrid, kernel);
  // Phi with node i displaced: F_p = (I + (x_i' - x_i) grad w_ip^T) FE_p [M 26].
  auto energy = [&](int node, const Vector3d& displacement) {
    Particles displaced = particles;
    for (int p = 0; p < particles.count(); ++p) {
      for (const Neighbor& n : neighbors(kGrid, kernel, particles.position[p])) {
        if (n.node != node) continue;
        displaced.elastic[p] = (Matrix3d::Identity() + displacement * n.gradient.transpose()) * particles.elastic[p];
      }
    }
    return elastic_energy(displaced, kMaterials);
  };
  double largest = 0;
  for (const Vector3d& f : force) largest = std::max(largest, f.norm());
  const double e = 1e-7;
  for (const Neighbor& n : neighbors(kGrid, kernel, particles.position[0])) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d shift = e * Vector3d::Unit(axis);
      const double numeric = -(energy(n.node, shift) - energy(n.node, -shift)) / (2 * e);
      CHECK(std::abs(force[n.node][axis] - numeric) < 1e-6 * largest);
    }
  }
}

TEST_CASE("the grid update is Newton's law per node, and leaves nodes without mass at rest") {
  GridState state;
  state.mass = {2, 0};
  state.momentum = {{4, 0, -2}, {0, 0, 0}};
  state.force = {{0, 8, 0}, {0, 0, 0}};
  grid_update(state, {0, -10, 0}, 0.5);
  CHECK(state.velocity_before[0] == Vector3d(2, 0, -1));
  CHECK((state.velocity[0] - Vector3d(2, -3, -1)).norm() < 1e-15);
  CHECK(state.velocity_before[1] == Vector3d(0, 0, 0));
  CHECK(state.velocity[1] == Vector3d(0, 0, 0));
}

TEST_CASE("grid collision acts on the nodes inside that carry mass, on v* alone") {
  GridState state;
  const Vector3d down(1, -1, 0);
  state.mass.assign(kGrid.count(), 1);
  state.mass[kGrid.index(3, 0, 3)] = 0;
  state.velocity_before.assign(kGrid.count(), down);
  state.velocity.assign(kGrid.count(), down);
  state.velocity[kGrid.index(3, 0, 3)] = Vector3d::Zero();
  Collider floor;
  floor.position = {0, 0.25, 0};  // rows j = 0 and 1 lie below
  floor.velocity = {0, 2, 0};
  grid_collide(state, kGrid, {floor});
  CHECK((state.velocity[kGrid.index(2, 0, 3)] - Vector3d(1, 2, 0)).norm() < 1e-15);
  CHECK((state.velocity[kGrid.index(2, 1, 3)] - Vector3d(1, 2, 0)).norm() < 1e-15);
  CHECK(state.velocity[kGrid.index(2, 2, 3)] == down);
  CHECK(state.velocity[kGrid.index(3, 0, 3)] == Vector3d(0, 0, 0));
  CHECK(state.velocity_before[kGrid.index(2, 0, 3)] == down);
}

TEST_CASE("particles take velocity and gradient of a linear grid field exactly") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Kernel kernel = GENERATE(Kernel::cubic, Kernel::quadratic);
  const Matrix3d a = random.matrix(3);
  const Vector3d b = random.vector(), change = random.vector();
  Particles particles = cloud(random, 20);
  const Particles before = particles;
  GridState state;
  for (int i = 0; i < kGrid.count(); ++i) {
    state.velocity.push_back(a * kGrid.position(i) + b);
    state.velocity_before.push_back(state.velocity.back() - change);
  }
  const double alpha = GENERATE(0.0, 0.95, 1.0);
  const std::vector<Matrix3d> gradient = grid_to_particles(particles, state, kGrid, kernel, alpha);
  for (int p = 0; p < particles.count(); ++p) {
    CHECK((gradient[p] - a).norm() < 1e-11);
    const Vector3d pic = a * particles.position[p] + b, flip = before.velocity[p] + change;
    CHECK((particles.velocity[p] - (1 - alpha) * pic - alpha * flip).norm() < 1e-12);
  }
}

TEST_CASE("there and back, transfers keep the momentum for every share of FLIP") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Kernel kernel = GENERATE(Kernel::cubic, Kernel::quadratic);
  const double alpha = GENERATE(0.0, 0.5, 0.95, 1.0);
  Particles particles = cloud(random, 50);
  const Vector3d before = momentum(particles);
  GridState state = particles_to_grid(particles, kGrid, kernel);
  state.force = grid_forces(particles, stress(particles, kMaterials), kGrid, kernel);
  grid_update(state, {0, 0, 0}, 1e-4);
  grid_to_particles(particles, state, kGrid, kernel, alpha);
  CHECK((momentum(particles) - before).norm() < 1e-11);
}
