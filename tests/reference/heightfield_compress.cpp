#include "tests/reference/heightfield_compress.h"

#include "tests/catch.h"
#include "tests/reference/fields.h"

using namespace firn::reference;

namespace {
// Everything of one cell, after compression by d.
struct Cell {
  double snow, density, pushed, pushed_volume;
};
Cell compress_cell(double snow, double density, double d, const Compression& c) {
  Field field = flat_field(1, 1, 2, snow, density);
  const Amounts out = compress(field, Cells::Constant(1, 1, d), c);
  return {field.snow(0, 0), field.density(0, 0), out.mass(0, 0), out.volume(0, 0)};
}
}  // namespace

TEST_CASE("the pushed share rises from 0 at the least to 1 at the greatest density") {
  const Compression c{100, 500, CompressionModel::conserving};
  CHECK(pushed_share(50, c) == 0);
  CHECK(pushed_share(100, c) == 0);
  CHECK(pushed_share(200, c) == Approx(0.25));
  CHECK(pushed_share(600, c) == 1);
  CHECK(pushed_share(99, {100, 100, CompressionModel::conserving}) == 0);
  CHECK(pushed_share(100, {100, 100, CompressionModel::conserving}) == 1);
}

TEST_CASE("both models agree where all is compressed or all is pushed") {
  const CompressionModel model = GENERATE(CompressionModel::conserving, CompressionModel::thesis);
  const Cell loose = compress_cell(1, 100, 0.5, {100, 500, model});
  CHECK(loose.density == Approx(200));
  CHECK(loose.snow == Approx(0.5));
  CHECK(loose.pushed == 0);
  const Cell dense = compress_cell(1, 500, 0.5, {100, 500, model});
  CHECK(dense.density == Approx(500));
  CHECK(dense.snow == Approx(0.5));
  CHECK(dense.pushed == Approx(500 * 0.5 * 4));
  CHECK(dense.pushed_volume == Approx(0.5 * 4));
}

TEST_CASE("between the two the thesis's model loses mass, ours does not") {
  // rho 300, W = Q = 1/2, S 1, D 1/2
  const Cell thesis = compress_cell(1, 300, 0.5, {100, 500, CompressionModel::thesis});
  CHECK(thesis.density == Approx(300 / 0.75));
  CHECK(thesis.density * thesis.snow + thesis.pushed / 4 == Approx(300 - 25));
  const Cell ours = compress_cell(1, 300, 0.5, {100, 500, CompressionModel::conserving});
  CHECK(ours.density == Approx(450));
  CHECK(ours.pushed == Approx(75 * 4));
  CHECK(ours.density * ours.snow + ours.pushed / 4 == Approx(300));
}

TEST_CASE("density stops at its maximum and the rest is pushed away") {
  const Cell cell = compress_cell(1, 100, 0.9, {100, 500, CompressionModel::conserving});
  CHECK(cell.density == 500);
  CHECK(cell.snow == Approx(0.1));
  CHECK(cell.pushed == Approx((100 - 50) * 4));
  CHECK(cell.pushed_volume == Approx(cell.pushed / 100));
}

TEST_CASE("a body on the ground pushes all snow away") {
  const CompressionModel model = GENERATE(CompressionModel::conserving, CompressionModel::thesis);
  const Cell cell = compress_cell(0.7, 100, 0.7, {100, 500, model});
  CHECK(cell.snow == 0);
  CHECK(cell.pushed == Approx(0.7 * 100 * 4));
}

TEST_CASE("the conserving model keeps the mass of any field, and touches only overlapped cells") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  Field field = random_field(random, 20, 30, 0.1);
  const Field before = field;
  const Cells d = (random_cells(random, 20, 30, -0.5, 1.2)).max(0).min(field.snow);
  const Amounts pushed = compress(field, d, {});
  CHECK(mass(field) + pushed.mass.sum() == Approx(mass(before)).epsilon(1e-13));
  CHECK(pushed.mass.minCoeff() >= 0);
  CHECK(field.snow.minCoeff() >= 0);
  for (int z = 0; z < 20; ++z) {
    for (int x = 0; x < 30; ++x) {
      if (d(z, x) > 0) {
        CHECK(field.snow(z, x) == Approx(before.snow(z, x) - d(z, x)).margin(1e-15));
        CHECK(field.density(z, x) <= 500);
        CHECK(pushed.mass(z, x) == Approx(pushed.volume(z, x) * before.density(z, x)));
      } else {
        CHECK(field.snow(z, x) == before.snow(z, x));
        CHECK(field.density(z, x) == before.density(z, x));
        CHECK(pushed.mass(z, x) == 0);
      }
    }
  }
}
