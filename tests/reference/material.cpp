#include "tests/reference/material.h"

#include "tests/catch.h"
#include "tests/reference/random.h"

using namespace firn::reference;

namespace {
const Material kSnow;  // Stomakhin's

Particles one_particle(const Matrix3d& elastic, double plastic_det = 1) {
  Particles particles;
  particles.add({0, 0, 0}, {0, 0, 0}, 0.4, 1e-3);
  particles.elastic[0] = elastic;
  particles.plastic_det[0] = plastic_det;
  return particles;
}

Matrix3d numeric_gradient(const Matrix3d& f, const Lame& l) {
  const double e = 1e-6;
  Matrix3d result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      Matrix3d up = f, down = f;
      up(row, column) += e;
      down(row, column) -= e;
      result(row, column) = (energy_density(up, l) - energy_density(down, l)) / (2 * e);
    }
  }
  return result;
}
}  // namespace

TEST_CASE("Lame parameters of known elastic constants") {
  Material m;
  m.young = 2.6;
  m.poisson = 0.3;
  CHECK(lame(m).mu == Approx(1));
  CHECK(lame(m).lambda == Approx(1.5));
  m.hardening = 10;
  CHECK(hardened(m, 1).mu == Approx(1));
  CHECK(hardened(m, 0.9).mu == Approx(std::exp(1)));  // compressed snow is harder
  CHECK(hardened(m, 0.9).lambda == Approx(1.5 * std::exp(1)));
  CHECK(hardened(m, 1.1).mu == Approx(std::exp(-1)));
}

TEST_CASE("the cofactor matrix is J F^-T, and exists where the inverse does not") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix3d f = Matrix3d::Identity() + random.matrix(0.3);
    CHECK((cofactor(f) - f.determinant() * f.inverse().transpose()).norm() < 1e-12);
  }
  CHECK((cofactor(Vector3d(2, 3, 0).asDiagonal()) - Matrix3d(Vector3d(0, 0, 6).asDiagonal())).norm() < 1e-15);
}

TEST_CASE("P is the derivative of the energy by FE at fixed hardening") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  for (int trial = 0; trial < 100; ++trial) {
    const Lame l = hardened(kSnow, random.uniform(0.9, 1.1));
    // Singular values apart from -each other's, where the rotation would jump; inverted ones too.
    const double last = random.uniform(0.6, 0.9) * (trial % 4 == 0 ? -1 : 1);
    const Matrix3d f = random.rotation() * Vector3d(random.uniform(1, 1.4), 1, last).asDiagonal() * random.rotation();
    CAPTURE(f);
    const Matrix3d p = first_piola_kirchhoff(f, l);
    CHECK((p - numeric_gradient(f, l)).norm() <= 1e-7 * (l.mu + l.lambda));
    CHECK(p.norm() > 1e-3 * l.mu);
  }
}

TEST_CASE("small strains give Hooke's law") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Lame l = lame(kSnow);
  const Matrix3d gradient = random.matrix(1e-7);
  const Matrix3d strain = (gradient + gradient.transpose()) / 2;
  const Matrix3d hooke = 2 * l.mu * strain + l.lambda * strain.trace() * Matrix3d::Identity();
  CHECK((first_piola_kirchhoff(Matrix3d::Identity() + gradient, l) - hooke).norm() < 1e-5 * hooke.norm());
}

TEST_CASE("rotations carry no energy and no stress, and turn the stress of what they rotate") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  for (int trial = 0; trial < 50; ++trial) {
    const Lame l = lame(kSnow);
    const Matrix3d r = random.rotation();
    CHECK(energy_density(r, l) < 1e-20);
    CHECK(first_piola_kirchhoff(r, l).norm() < 1e-9);
    const Matrix3d f = Matrix3d::Identity() + random.matrix(0.2);
    CHECK(energy_density(r * f, l) == Approx(energy_density(f, l)));
    CHECK((first_piola_kirchhoff(r * f, l) - r * first_piola_kirchhoff(f, l)).norm() < 1e-7);
    CHECK((first_piola_kirchhoff(f * r, l) - first_piola_kirchhoff(f, l) * r).norm() < 1e-7);  // isotropic
    const Matrix3d tau = stress(one_particle(f), {kSnow})[0];
    const Matrix3d turned = stress(one_particle(r * f), {kSnow})[0];
    CHECK((turned - r * tau * r.transpose()).norm() < 1e-10 * (1 + tau.norm()));
    CHECK((tau - tau.transpose()).norm() < 1e-10 * (1 + tau.norm()));
  }
}

TEST_CASE("tau is V0 J times the Cauchy stress of the particle's own hardened material") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  Material stiff;
  stiff.young = 1e6;
  Particles particles = one_particle(Matrix3d::Identity() + random.matrix(0.1), 0.95);
  particles.material[0] = 1;
  particles.volume[0] = 0.02;
  const Matrix3d f = particles.elastic[0];
  const Matrix3d cauchy = first_piola_kirchhoff(f, hardened(stiff, 0.95)) * f.transpose() / f.determinant();
  const Matrix3d tau = stress(particles, {kSnow, stiff})[0];
  CHECK((tau - 0.02 * f.determinant() * cauchy).norm() < 1e-10 * tau.norm());
  CHECK(elastic_energy(particles, {kSnow, stiff}) == Approx(0.02 * energy_density(f, hardened(stiff, 0.95))));
}

TEST_CASE("deform keeps small deformations elastic") {
  const Matrix3d gradient = Vector3d(0.5, -1, 0.25).asDiagonal();
  Particles particles = one_particle(Matrix3d::Identity());
  deform(particles, {gradient}, {kSnow}, 1e-2);  // stretch 0.5 %, compression 1 %
  CHECK((particles.elastic[0] - Matrix3d(Vector3d(1.005, 0.99, 1.0025).asDiagonal())).norm() < 1e-14);
  CHECK(particles.plastic_det[0] == Approx(1).epsilon(1e-14));
}

TEST_CASE("deform cuts the elastic part at 1 - theta_c and 1 + theta_s and gives the rest to J_P") {
  const Matrix3d gradient = Vector3d(5, -10, 0.25).asDiagonal();
  Particles particles = one_particle(Matrix3d::Identity());
  deform(particles, {gradient}, {kSnow}, 1e-2);
  CHECK((particles.elastic[0] - Matrix3d(Vector3d(1.0075, 0.975, 1.0025).asDiagonal())).norm() < 1e-14);
  CHECK(particles.plastic_det[0] == Approx(1.05 / 1.0075 * 0.9 / 0.975));
}

TEST_CASE("deform multiplies the total deformation by I + dt grad v, whatever is cut") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const double dt = 1e-3;
  Particles particles = one_particle(Matrix3d::Identity());
  Material wide = kSnow;
  wide.critical_compression = wide.critical_stretch = 10;
  Particles elastic_only = one_particle(Matrix3d::Identity());
  Matrix3d total = Matrix3d::Identity();
  for (int step = 0; step < 100; ++step) {
    const Matrix3d gradient = random.matrix(20);
    total = (Matrix3d::Identity() + dt * gradient) * total;
    deform(particles, {gradient}, {kSnow}, dt);
    deform(elastic_only, {gradient}, {wide}, dt);
    const Vector3d s = svd(particles.elastic[0]).s;
    CHECK(s[0] <= 1 + kSnow.critical_stretch + 1e-12);
    CHECK(s[2] >= 1 - kSnow.critical_compression - 1e-12);
    CHECK(particles.elastic[0].determinant() * particles.plastic_det[0] == Approx(total.determinant()));
  }
  CHECK((elastic_only.elastic[0] - total).norm() < 1e-11);
  CHECK(elastic_only.plastic_det[0] == Approx(1));
}
