#pragma once

// Random particles, materials, bodies and grids, the same for a stage and its reference: every number is exact in single precision.

#include "tests/catch.h"
#include "tests/reference/mpm.h"
#include "tests/reference/random.h"
#include "tests/stages/harness.h"

namespace firn::test {

using reference::Matrix3d;
using reference::Vector3d;

inline double single(double value) { return static_cast<float>(value); }
inline Vector3d single(const Vector3d& v) { return v.cast<float>().cast<double>(); }
inline Matrix3d single(const Matrix3d& m) { return m.cast<float>().cast<double>(); }

struct RandomSnow {
  explicit RandomSnow(std::uint64_t seed, int count = 500);

  reference::Random random;
  reference::Particles particles;
  reference::Grid grid;
  std::vector<reference::Material> materials;
  std::vector<reference::Collider> colliders;
  std::vector<Matrix3d> gradient;  // grad v_p

  [[nodiscard]] GridSetup setup() const;
  // Port values of particles, materials and bodies.
  [[nodiscard]] Arrays arrays(std::initializer_list<const char*> ports) const;
};

std::vector<float> flat(const std::vector<double>& values);
std::vector<float> flat(const std::vector<Vector3d>& values);
std::vector<float> flat(const std::vector<Matrix3d>& values);  // row by row

// max |a - b| / max |b|; infinite where sizes differ or a is not finite.
double relative_error(const std::vector<float>& a, const std::vector<float>& b);

}  // namespace firn::test
