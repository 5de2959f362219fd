#pragma once

// The field of H1 and what moves in it. Arrays are [z, x]: row 0 at the smallest z, column 0 at the smallest x, x fastest in
// memory.

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <vector>

namespace firn::reference {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Cells = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Owners = Eigen::Array<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Field {
  double h = 1;           // edge of a cell, m
  Vector2d origin{0, 0};  // x and z of the field's lowest corner, m
  Cells ground;           // B, m
  Cells snow;             // S >= 0, m
  Cells density;          // rho, kg/m3; means nothing where there is no snow

  [[nodiscard]] int rows() const { return static_cast<int>(snow.rows()); }
  [[nodiscard]] int columns() const { return static_cast<int>(snow.cols()); }
  [[nodiscard]] Cells surface() const { return ground + snow; }  // H [H 3.1], m
};

inline bool inside(const Cells& cells, int z, int x) { return z >= 0 && x >= 0 && z < cells.rows() && x < cells.cols(); }

// M = sum rho S h^2, kg.
inline double mass(const Field& field) { return (field.density * field.snow).sum() * field.h * field.h; }

// U: the lowest point of any body over each cell, m; +infinity and owner -1 where there is none.
struct Underside {
  Cells height;
  Owners owner;  // which body, an index
};

// D [H 3.2, 3.4]: how far bodies reach into the snow, m; never more than the snow.
inline Cells overlap(const Field& field, const Underside& underside) {
  return (field.surface() - underside.height).max(0).min(field.snow);
}

// H2 [H 3.6-3.8], per body.
struct Resistance {
  double mass = 0;          // displaced, kg
  Vector3d point{0, 0, 0};  // x0, m: mean over the underside (its height is H - D); 0 where mass is 0
  Vector3d force{0, 0, 0};  // N
};

// `velocity`: per body, m/s. `time`: within which the body would give its velocity to the displaced snow, s.
inline std::vector<Resistance> resistance(const Field& field, const Cells& overlap, const Owners& owner,
                                          const std::vector<Vector3d>& velocity, double time) {
  std::vector<Resistance> result(velocity.size());
  for (int z = 0; z < field.rows(); ++z) {
    for (int x = 0; x < field.columns(); ++x) {
      if (overlap(z, x) <= 0) continue;
      Resistance& body = result.at(owner(z, x));
      const double displaced = overlap(z, x) * field.density(z, x) * field.h * field.h;
      const double height = field.ground(z, x) + field.snow(z, x) - overlap(z, x);
      body.mass += displaced;
      body.point += displaced * Vector3d(field.origin.x() + field.h * (x + 0.5), height, field.origin.y() + field.h * (z + 0.5));
    }
  }
  for (std::size_t b = 0; b < result.size(); ++b) {
    if (result[b].mass > 0) result[b].point /= result[b].mass;
    result[b].force = -result[b].mass * velocity[b] / time;
  }
  return result;
}

// Snow on its way, per cell. The volume goes along so that empty cells know the density of what arrives.
struct Amounts {
  Cells mass;    // kg
  Cells volume;  // m3

  static Amounts none(const Cells& like) { return {Cells::Zero(like.rows(), like.cols()), Cells::Zero(like.rows(), like.cols())}; }
  void add(int z, int x, double share, double all_mass, double all_volume) {
    mass(z, x) += share * all_mass;
    volume(z, x) += share * all_volume;
  }
};

// Lays snow down: S += mass / (rho h^2); a cell without snow takes the density of what arrives.
inline void deposit(Field& field, const Amounts& arriving) {
  for (int z = 0; z < field.rows(); ++z) {
    for (int x = 0; x < field.columns(); ++x) {
      if (arriving.mass(z, x) <= 0) continue;
      if (field.snow(z, x) <= 0) field.density(z, x) = arriving.mass(z, x) / arriving.volume(z, x);
      field.snow(z, x) += arriving.mass(z, x) / (field.density(z, x) * field.h * field.h);
    }
  }
}

}  // namespace firn::reference
