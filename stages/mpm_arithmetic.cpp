#include "stages/mpm_arithmetic.h"

namespace firn::stages::mpm::arithmetic {

std::vector<graph::Arithmetic> per_particle(double per_node, double once) {
  return {{.per = "particles", .operations = once + 4 * splines + 64 * per_node, .when = {"kernel", "cubic"}},
          {.per = "particles", .operations = once + 3 * splines + 27 * per_node, .when = {"kernel", "quadratic"}}};
}

}  // namespace firn::stages::mpm::arithmetic
