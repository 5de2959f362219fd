#pragma once

// H3 [H 3.9-3.11]: what a body displaces is partly pressed together in its cell and partly pushed away.

#include "tests/reference/heightfield_field.h"

namespace firn::reference {

enum class CompressionModel { conserving, thesis };

struct Compression {
  double min_density = 30;   // rho_min, kg/m3: below, nothing is pushed away
  double max_density = 500;  // rho_max, kg/m3: above, all of it
  CompressionModel model = CompressionModel::conserving;
};

// W, the share of the overlap that is pushed away.
inline double pushed_share(double density, const Compression& c) {
  if (c.max_density <= c.min_density) return density >= c.min_density ? 1 : 0;
  return std::clamp((density - c.min_density) / (c.max_density - c.min_density), 0.0, 1.0);
}

// Lowers the snow to the bodies' underside, presses what stays, and returns what is pushed out of each cell at the density it had.
inline Amounts compress(Field& field, const Cells& overlap, const Compression& c) {
  Amounts pushed = Amounts::none(overlap);
  for (int z = 0; z < field.rows(); ++z) {
    for (int x = 0; x < field.columns(); ++x) {
      const double d = overlap(z, x), s = field.snow(z, x), density = field.density(z, x), rest = s - d;
      if (d <= 0) continue;
      double leaving = density * s;  // kg/m2; all of it where the body stands on the ground
      if (rest > 0) {
        const double w = pushed_share(density, c), q = 1 - w;
        const double pressed = c.model == CompressionModel::conserving ? density * (s - d * w) / rest : density * s / (s - d * q);
        field.density(z, x) = std::min(pressed, c.max_density);
        leaving = density * d * w + (pressed - field.density(z, x)) * rest;
      }
      field.snow(z, x) = std::max(rest, 0.0);
      pushed.add(z, x, field.h * field.h, leaving, leaving / density);
    }
  }
  return pushed;
}

}  // namespace firn::reference
