#include "tests/reference/heightfield_contour.h"

#include <map>

#include "tests/catch.h"
#include "tests/reference/fields.h"

using namespace firn::reference;

namespace {
struct Footprint {
  Cells overlap;
  Owners owner;
};
Footprint empty(int rows, int columns) { return {Cells::Zero(rows, columns), Owners::Constant(rows, columns, -1)}; }
void put(Footprint& f, int body, int z, int x, int rows, int columns, double depth = 1) {
  f.overlap.block(z, x, rows, columns).setConstant(depth);
  f.owner.block(z, x, rows, columns).setConstant(body);
}
// What leaves: `depth` kg per cell at 100 kg/m3 and body.
Amounts displaced(const Footprint& f) { return {f.overlap, f.overlap / 100}; }
std::map<std::pair<int, int>, ContourCell> by_place(const std::vector<ContourCell>& cells) {
  std::map<std::pair<int, int>, ContourCell> result;
  for (const ContourCell& cell : cells) result.emplace(std::pair{cell.z, cell.x}, cell);
  return result;
}
}  // namespace

TEST_CASE("the contour is the ring of cells around the footprint, each with its way out") {
  Footprint f = empty(9, 9);
  put(f, 0, 3, 3, 3, 3);
  const auto ring = by_place(contour(f.overlap, f.owner, 0, {0, -1, 0}, {}));
  CHECK(ring.size() == 16);
  auto outward = [&](int z, int x) { return ring.at({z, x}).outward; };
  CHECK((outward(4, 2) - Vector2d(-1, 0)).norm() < 1e-15);
  CHECK((outward(4, 6) - Vector2d(1, 0)).norm() < 1e-15);
  CHECK((outward(2, 4) - Vector2d(0, -1)).norm() < 1e-15);
  CHECK((outward(6, 4) - Vector2d(0, 1)).norm() < 1e-15);
  CHECK((outward(6, 6) - Vector2d(1, 1).normalized()).norm() < 1e-15);
  // Beside the corner, weights 1 2 1: two cells of the footprint in the next column (2 + 1), one in the row (1).
  CHECK((outward(3, 6) - Vector2d(3, -1).normalized()).norm() < 1e-15);
  for (const auto& [place, cell] : ring) CHECK(cell.factor == Approx(1.0 / 8));
}

TEST_CASE("a body that goes straight down spreads its snow evenly over the contour") {
  Footprint f = empty(9, 9);
  put(f, 0, 3, 3, 3, 3, 2);
  const Amounts arriving = distribute_contour(displaced(f), f.overlap, f.owner, {{0, -1, 0}}, {});
  CHECK(arriving.mass.sum() == Approx(18));
  CHECK(arriving.volume.sum() == Approx(0.18));
  CHECK((arriving.mass > 0).count() == 16);
  CHECK(arriving.mass(2, 2) == Approx(18.0 / 16));
  CHECK(arriving.mass.block(3, 3, 3, 3).maxCoeff() == 0);
}

TEST_CASE("a body that moves level pushes snow ahead of it only, in proportion to the cosine") {
  Footprint f = empty(9, 9);
  put(f, 0, 3, 3, 3, 3);
  const Amounts arriving = distribute_contour(displaced(f), f.overlap, f.owner, {{0, 0, 5}}, {});
  // Cosines along the ring of rows 6, 5, 4, 3 (+z is ahead): the front row, then the sides' shrinking tilts.
  const double corner = std::sqrt(0.5), front = 3 / std::sqrt(10), side = 1 / std::sqrt(10);
  const double k_t = 1 + 2 * front + 2 * corner + 2 * side;
  CHECK(arriving.mass(6, 4) == Approx(9 / k_t));
  CHECK(arriving.mass(6, 3) == Approx(9 * front / k_t));
  CHECK(arriving.mass(6, 6) == Approx(9 * corner / k_t));
  CHECK(arriving.mass(5, 2) == Approx(9 * side / k_t));
  CHECK(arriving.mass(4, 2) == Approx(0).margin(1e-15));
  CHECK(arriving.mass(2, 4) == Approx(0).margin(1e-15));
  CHECK(arriving.mass.sum() == Approx(9));
}

TEST_CASE("where no contour cell is pushed the snow is spread evenly, where there is none it stays") {
  Footprint f = empty(4, 6);
  put(f, 0, 0, 3, 4, 3);  // up to the edge it moves towards
  const Amounts even = distribute_contour(displaced(f), f.overlap, f.owner, {{1, 0, 0}}, {});
  for (int z = 0; z < 4; ++z) CHECK(even.mass(z, 2) == Approx(3));
  CHECK(even.mass.sum() == Approx(12));
  put(f, 0, 0, 0, 4, 6);
  const Amounts kept = distribute_contour(displaced(f), f.overlap, f.owner, {{1, 0, 0}}, {});
  CHECK((kept.mass - f.overlap).abs().maxCoeff() == 0);
}

TEST_CASE("a hole in the footprint takes the downward share alone") {
  Footprint f = empty(7, 7);
  put(f, 0, 2, 2, 3, 3);
  f.overlap(3, 3) = 0;
  const auto ring = by_place(contour(f.overlap, f.owner, 0, {1, -1, 0}, {}));
  CHECK(ring.size() == 17);
  CHECK(ring.at({3, 3}).outward.norm() == 0);
  CHECK(ring.at({3, 3}).factor == Approx(0.5 / 8));
}

TEST_CASE("a cell between two bodies is on the contour of the one that pushes more there") {
  Footprint f = empty(7, 11);
  put(f, 0, 2, 2, 3, 3, 1);
  put(f, 1, 2, 6, 3, 3, 4);  // column 5 lies between
  const std::vector<Vector3d> velocity{{1, 0, 0}, {0, -1, 0}};
  const Contours around = contours(f.overlap, f.owner, velocity, {});
  CHECK(around.owner(3, 5) == 0);  // 1 ahead of the first, 1/8 beside the second
  CHECK(around.weight(3, 5) == Approx(1));
  CHECK(around.owner(3, 9) == 1);
  CHECK(around.owner(3, 1) == 0);
  CHECK(contours(f.overlap, f.owner, {{0, -1, 0}, {0, -1, 0}}, {}).owner(3, 5) == 0);
  const Amounts both = distribute_contour(displaced(f), f.overlap, f.owner, velocity, {});
  CHECK(both.mass.sum() == Approx(9 + 36));
  CHECK((around.owner == 1).select(both.mass, 0.0).sum() == Approx(36));
  // Touching bodies: nothing lands under the other.
  put(f, 1, 2, 5, 3, 4, 4);
  const Amounts touching = distribute_contour(displaced(f), f.overlap, f.owner, velocity, {});
  CHECK(touching.mass.sum() == Approx(9 + 48));
  CHECK((f.overlap > 0).select(touching.mass, 0.0).maxCoeff() == 0);
}
