#include "tests/reference/time_step.h"

#include "tests/catch.h"
#include "tests/reference/random.h"

using namespace firn::reference;

TEST_CASE("pressure waves are as fast as the stiffness of a stretch along them tells") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  for (int i = 0; i < 20; ++i) {
    Material m;
    m.young = random.uniform(1e4, 1e6);
    m.poisson = random.uniform(0, 0.45);
    m.density = random.uniform(100, 900);
    const double plastic_det = random.uniform(0.8, 1.1);
    // rho c^2 is what P_xx gains where F_xx does: the wave equation of small motions along x.
    const double e = 1e-6;
    Matrix3d longer = Matrix3d::Identity(), shorter = longer;
    longer(0, 0) += e;
    shorter(0, 0) -= e;
    const Lame l = hardened(m, plastic_det);
    const double stiffness = (first_piola_kirchhoff(longer, l)(0, 0) - first_piola_kirchhoff(shorter, l)(0, 0)) / (2 * e);
    CHECK(wave_speed(m, plastic_det) == Approx(std::sqrt(stiffness / m.density)).epsilon(1e-6));
  }
}

TEST_CASE("equal steps fill the time that is left, none too long, and no fewer would do") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  for (int i = 0; i < 200; ++i) {
    const double left = random.uniform(1e-5, 0.1), speed = random.uniform(0.1, 300), cfl = random.uniform(0.1, 1), cell = 0.05;
    const double steps = steps_until(left, speed, cfl, cell);
    CHECK(steps == std::floor(steps));
    CHECK(left / steps * speed <= cfl * cell * (1 + 1e-12));
    if (steps > 1) CHECK(left / (steps - 1) * speed > cfl * cell);
  }
  CHECK(steps_until(0.1, 0, 0.4, 0.05) == 1);
}

TEST_CASE("the fastest is a particle with its waves, not the one that moves most") {
  Material soft, hard;
  soft.young = 1e4;
  hard.young = 1e6;
  Particles particles;
  particles.add({0, 0, 0}, {3, 0, 0}, 1, 1, 0);
  particles.add({0, 0, 0}, {0, 0, 1}, 1, 1, 1);
  CHECK(fastest(particles, {soft, hard}) == Approx(1 + wave_speed(hard, 1)));
  CHECK(fastest({}, {soft}) == 0);
}
