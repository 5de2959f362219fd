#pragma once

// Singular values in the convention of M3: U and V are proper rotations, a negative sign goes to the smallest singular value.

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace firn::reference {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Svd {
  Matrix3d u, v;
  Vector3d s;  // |s_0| >= |s_1| >= |s_2|; only s_2 may be negative
};

// F = U diag(s) V^T, for any F: also rotations, reflections and rank-deficient ones.
inline Svd svd(const Matrix3d& f) {
  const Eigen::JacobiSVD<Matrix3d> full(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Svd result{full.matrixU(), full.matrixV(), full.singularValues()};
  if (result.u.determinant() < 0) {
    result.u.col(2) *= -1;
    result.s[2] *= -1;
  }
  if (result.v.determinant() < 0) {
    result.v.col(2) *= -1;
    result.s[2] *= -1;
  }
  return result;
}

// R of the polar decomposition F = R S: the nearest proper rotation, also where det F < 0.
inline Matrix3d polar_rotation(const Matrix3d& f) {
  const Svd parts = svd(f);
  return parts.u * parts.v.transpose();
}

}  // namespace firn::reference
