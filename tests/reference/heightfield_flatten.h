#pragma once

// H6 [H 3.29-3.33, alg. 4.11]: snow slides off slopes that are too steep.

#include "tests/reference/heightfield_distance.h"

namespace firn::reference {

enum class Diagonal { euclidean, thesis };  // thesis: a diagonal neighbour is as near as the others

struct Flattening {
  double slope = 0.6;  // phi, m/m
  Diagonal diagonal = Diagonal::euclidean;
  double relaxation = 1;  // share of c/n that moves in one iteration
  // Heights that differ by less count as equal, m. At 0 two heights that should be equal are told apart by their rounding: the
  // lower one receives, which moves whole shares and breaks the symmetry of symmetric snow.
  double tie = 0;
};

struct Flattened {
  Field field;
  Cells given;  // height that each cell gave away, m
};

// One iteration: everything is read from `old`. Also which cells are empty, and so take the density of what arrives.
inline Flattened flatten(const Field& old, const Cells& underside, const Flattening& f) {
  const Cells height = old.surface();
  Flattened result{old, Cells::Zero(height.rows(), height.cols())};
  Amounts arriving = Amounts::none(height);
  for (int z = 0; z < old.rows(); ++z) {
    for (int x = 0; x < old.columns(); ++x) {
      std::vector<Offset> receivers;
      double excess = 0;  // c
      int steep = 0;      // n
      for (const Offset& step : kNeighbors) {
        const int to_z = z + step.z, to_x = x + step.x;
        if (!inside(height, to_z, to_x)) continue;
        if (height(to_z, to_x) >= height(z, x) - f.tie || height(z, x) >= underside(to_z, to_x)) continue;
        receivers.push_back({to_z, to_x});
        const bool diagonal = step.z != 0 && step.x != 0;
        const double length = diagonal && f.diagonal == Diagonal::euclidean ? std::sqrt(2.0) * old.h : old.h;
        const double e = height(z, x) - height(to_z, to_x) - f.slope * length;
        if (e > 0) {
          excess += e;
          ++steep;
        }
      }
      if (steep == 0) continue;
      const double given = std::min(f.relaxation * excess / steep, old.snow(z, x));
      result.given(z, x) = given;
      const double volume = given * old.h * old.h;
      for (const Offset& to : receivers) {
        arriving.add(to.z, to.x, 1.0 / static_cast<double>(receivers.size()), old.density(z, x) * volume, volume);
      }
    }
  }
  for (int z = 0; z < old.rows(); ++z) {
    for (int x = 0; x < old.columns(); ++x) {
      const double mass = arriving.mass(z, x);
      double& density = result.field.density(z, x);
      if (mass > 0 && old.snow(z, x) <= 0) density = mass / arriving.volume(z, x);
      result.field.snow(z, x) += (mass > 0 ? mass / (density * old.h * old.h) : 0) - result.given(z, x);
    }
  }
  return result;
}

}  // namespace firn::reference
