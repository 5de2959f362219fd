#pragma once

// What the material-point model keeps from one step to the next.

#include <Eigen/Core>
#include <vector>

namespace firn::reference {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// All arrays have one entry per particle.
struct Particles {
  std::vector<Vector3d> position;   // m
  std::vector<Vector3d> velocity;   // m/s
  std::vector<double> mass;         // kg
  std::vector<double> volume;       // V_p0, m3
  std::vector<double> plastic_det;  // J_P = det F_P
  std::vector<Matrix3d> elastic;    // F_E
  std::vector<int> material;        // index into the list of materials

  [[nodiscard]] int count() const { return static_cast<int>(position.size()); }

  // A particle without deformation.
  void add(const Vector3d& x, const Vector3d& v, double m, double volume0, int material_index = 0) {
    position.push_back(x);
    velocity.push_back(v);
    mass.push_back(m);
    volume.push_back(volume0);
    plastic_det.push_back(1);
    elastic.push_back(Matrix3d::Identity());
    material.push_back(material_index);
  }
};

}  // namespace firn::reference
