#include "tests/reference/affine.h"

#include "tests/catch.h"
#include "tests/reference/material.h"
#include "tests/reference/random.h"

using namespace firn::reference;

namespace {

const Grid grid{{-0.2, 0.1, 0.3}, 0.1, {9, 8, 10}};
const std::vector<Material> materials{Material{}, Material{8e5, 0.3, 5, 2e-2, 5e-3, 300}};
constexpr double dt = 1e-4;

struct Cloud {
  explicit Cloud(Random& random) {
    for (int p = 0; p < 60; ++p) {
      const Vector3d u(random.uniform(1.1, 5.9), random.uniform(1.1, 4.9), random.uniform(1.1, 6.9));
      particles.add(grid.min + grid.h * u, random.vector(4), random.uniform(0.02, 0.06), random.uniform(1e-4, 2e-4), p % 2);
      particles.elastic.back() = random.rotation() * (Matrix3d::Identity() + random.matrix(0.1));
      affine.push_back(random.matrix(20));
    }
  }
  Particles particles;
  std::vector<Matrix3d> affine;
};

Vector3d momentum(const Particles& particles) {
  Vector3d sum = Vector3d::Zero();
  for (int p = 0; p < particles.count(); ++p) sum += particles.mass[p] * particles.velocity[p];
  return sum;
}

}  // namespace

TEST_CASE("weighted squares of distances to the nodes of the quadratic kernel are h2 over 4") {
  Random random(firn::test::seed());
  INFO("seed " << firn::test::seed());
  for (const Vector3d& x : Cloud(random).particles.position) {
    Matrix3d sum = Matrix3d::Zero();
    for (const Neighbor& n : neighbors(grid, Kernel::quadratic, x)) {
      const Vector3d away = grid.position(n.node) - x;
      sum += n.weight * away * away.transpose();
    }
    CHECK((sum - affine_inertia(grid) * Matrix3d::Identity()).norm() < 1e-15);
  }
}

TEST_CASE("affine transfers keep momentum and angular momentum, whatever the stress") {
  Random random(firn::test::seed());
  INFO("seed " << firn::test::seed());
  Cloud cloud(random);
  const Vector3d linear = momentum(cloud.particles), angular = angular_momentum(cloud.particles, cloud.affine, grid);
  const GridState state =
      affine_to_grid(cloud.particles, cloud.affine, stress(cloud.particles, materials), grid, Vector3d::Zero(), dt);
  Vector3d linear_of_nodes = Vector3d::Zero(), angular_of_nodes = Vector3d::Zero();
  for (int i = 0; i < grid.count(); ++i) {
    linear_of_nodes += state.momentum[i];
    angular_of_nodes += grid.position(i).cross(state.momentum[i]);
  }
  CHECK((linear_of_nodes - linear).norm() < 1e-12);
  CHECK((angular_of_nodes - angular).norm() < 1e-12);
  cloud.affine = grid_to_particles_affine(cloud.particles, state, grid);
  CHECK((momentum(cloud.particles) - linear).norm() < 1e-12);
  CHECK((angular_momentum(cloud.particles, cloud.affine, grid) - angular).norm() < 1e-12);
}

TEST_CASE("velocities that are affine in space come through both transfers as they were") {
  Random random(firn::test::seed());
  INFO("seed " << firn::test::seed());
  Cloud cloud(random);
  const Matrix3d slope = random.matrix(10);
  const Vector3d at_origin = random.vector(3);
  for (int p = 0; p < cloud.particles.count(); ++p) cloud.particles.velocity[p] = at_origin + slope * cloud.particles.position[p];
  cloud.affine.assign(cloud.affine.size(), slope);
  const Particles before = cloud.particles;
  const std::vector<Matrix3d> no_stress(cloud.affine.size(), Matrix3d::Zero());
  const GridState state = affine_to_grid(cloud.particles, cloud.affine, no_stress, grid, Vector3d(0, -9.81, 0), dt);
  cloud.affine = grid_to_particles_affine(cloud.particles, state, grid);
  for (int p = 0; p < cloud.particles.count(); ++p) {
    CHECK((cloud.particles.velocity[p] - before.velocity[p] - dt * Vector3d(0, -9.81, 0)).norm() < 1e-11);
    CHECK((cloud.affine[p] - slope).norm() < 1e-10);
  }
}

TEST_CASE("forces of MLS-MPM do the work that the particles' energy loses") {
  // d Phi = sum_p tau_p : C_p dt for velocities v_i of nodes, and the power of the forces is sum_i f_i . v_i.
  Random random(firn::test::seed());
  INFO("seed " << firn::test::seed());
  Cloud cloud(random);
  const std::vector<Matrix3d> tau = stress(cloud.particles, materials);
  const Cloud still = [&] {
    Cloud copy = cloud;
    for (Vector3d& v : copy.particles.velocity) v.setZero();
    for (Matrix3d& c : copy.affine) c.setZero();
    return copy;
  }();
  const GridState impulses = affine_to_grid(still.particles, still.affine, tau, grid, Vector3d::Zero(), dt);
  GridState moving = impulses;
  for (Vector3d& v : moving.velocity) v = random.vector(1);
  double power = 0, lost = 0;
  for (int i = 0; i < grid.count(); ++i) power += impulses.momentum[i].dot(moving.velocity[i]) / dt;
  const std::vector<Matrix3d> gradient = grid_to_particles_affine(cloud.particles, moving, grid);
  const double small = 1e-6;
  Particles later = cloud.particles, earlier = cloud.particles;
  for (int p = 0; p < later.count(); ++p) {
    later.elastic[p] += small * gradient[p] * later.elastic[p];
    earlier.elastic[p] -= small * gradient[p] * earlier.elastic[p];
  }
  lost = (elastic_energy(earlier, materials) - elastic_energy(later, materials)) / (2 * small);
  CHECK(power == Approx(lost).epsilon(1e-6));
}
