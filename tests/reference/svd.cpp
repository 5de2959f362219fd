#include "tests/reference/svd.h"

#include "tests/catch.h"
#include "tests/reference/random.h"

using namespace firn::reference;

namespace {
void check_convention(const Matrix3d& f) {
  CAPTURE(f);
  const Svd parts = svd(f);
  CHECK((parts.u * parts.s.asDiagonal() * parts.v.transpose() - f).norm() <= 1e-13 * std::max(1.0, f.norm()));
  CHECK((parts.u.transpose() * parts.u - Matrix3d::Identity()).norm() < 1e-13);
  CHECK((parts.v.transpose() * parts.v - Matrix3d::Identity()).norm() < 1e-13);
  CHECK(parts.u.determinant() == Approx(1));
  CHECK(parts.v.determinant() == Approx(1));
  CHECK(parts.s[0] >= parts.s[1]);
  CHECK(parts.s[1] >= std::abs(parts.s[2]));
}
}  // namespace

TEST_CASE("F = U S V^T with proper rotations, for every kind of F") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  for (int trial = 0; trial < 100; ++trial) {
    check_convention(random.matrix());
    check_convention(random.rotation());
    check_convention(-random.rotation());
    check_convention(random.rotation() * Vector3d(1, 1, -1).asDiagonal());
    check_convention(Matrix3d::Identity() + random.matrix(1e-9));
    check_convention(random.vector() * random.vector().transpose());
    check_convention(random.rotation() * Vector3d(3, 2, 0).asDiagonal() * random.rotation());
    check_convention(1e6 * random.matrix() * Vector3d(1, 1e-6, 1e-12).asDiagonal());
  }
  check_convention(Matrix3d::Zero());
  check_convention(Matrix3d::Identity());
}

TEST_CASE("the sign of the determinant is that of the smallest singular value") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const Matrix3d left = random.rotation(), right = random.rotation();
  CHECK((svd(left * Vector3d(3, 2, 1).asDiagonal() * right).s - Vector3d(3, 2, 1)).norm() < 1e-13);
  CHECK((svd(left * Vector3d(3, 2, -1).asDiagonal() * right).s - Vector3d(3, 2, -1)).norm() < 1e-13);
  CHECK((svd(left * Vector3d(-3, 2, 1).asDiagonal() * right).s - Vector3d(3, 2, -1)).norm() < 1e-13);
  CHECK((svd(left * Vector3d(-3, -2, -1).asDiagonal() * right).s - Vector3d(3, 2, -1)).norm() < 1e-13);
}

TEST_CASE("the polar rotation is the proper rotation nearest to F, and leaves a symmetric factor") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix3d f = random.matrix();
    const Matrix3d r = polar_rotation(f);
    const Matrix3d s = r.transpose() * f;
    CHECK((s - s.transpose()).norm() < 1e-12);
    CHECK(r.determinant() == Approx(1));
    for (int other = 0; other < 20; ++other) {
      const Matrix3d candidate = r * Eigen::AngleAxisd(random.uniform(0, 3), random.direction()).toRotationMatrix();
      CHECK((f - r).norm() <= (f - candidate).norm() + 1e-12);
    }
  }
  const Matrix3d rotation = random.rotation();
  CHECK((polar_rotation(rotation) - rotation).norm() < 1e-13);
}
