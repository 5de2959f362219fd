#include "tests/reference/heightfield_field.h"

#include "tests/catch.h"
#include "tests/reference/fields.h"

using namespace firn::reference;

TEST_CASE("overlap is how far a body reaches into the snow, from nothing to all of it") {
  Field field = flat_field(1, 5, 0.5, 0.4, 100);
  field.ground.setConstant(2);
  Underside underside = nothing_above(1, 5);
  underside.height << 3, 2.4, 2.3, 2, 1.5;  // above, touching, 0.1 deep, on the ground, below it
  Cells expected(1, 5);
  expected << 0, 0, 0.1, 0.4, 0.4;
  CHECK((overlap(field, underside) - expected).abs().maxCoeff() < 1e-15);
  CHECK(overlap(field, nothing_above(1, 5)).maxCoeff() == 0);
}

TEST_CASE("resistance: a level body is met in its middle, against its motion") {
  Field field = flat_field(6, 8, 0.5, 0.4, 100);
  field.origin = {10, 20};
  Underside underside = nothing_above(6, 8);
  underside.height.block(1, 2, 3, 4).setConstant(0.3);
  underside.owner.block(1, 2, 3, 4).setConstant(1);
  const Vector3d v(1, -2, 3);
  const std::vector<Resistance> result = resistance(field, overlap(field, underside), underside.owner, {{9, 9, 9}, v}, 0.5);
  CHECK(result[0].mass == 0);
  CHECK(result[0].force.norm() == 0);
  CHECK(result[1].mass == Approx(12 * 0.1 * 100 * 0.25));
  CHECK((result[1].point - Vector3d(10 + 2, 0.3, 20 + 1.25)).norm() < 1e-13);
  CHECK((result[1].force + result[1].mass * v / 0.5).norm() < 1e-12);
}

TEST_CASE("resistance of a body that dips one side acts on that side") {
  Field field = flat_field(1, 4, 1, 1, 100);
  field.density(0, 3) = 300;
  Underside underside = nothing_above(1, 4);
  underside.height << 0.9, 0.9, 0.9, 0.7;
  underside.owner.setConstant(0);
  const std::vector<Resistance> result = resistance(field, overlap(field, underside), underside.owner, {{0, -1, 0}}, 1);
  CHECK(result[0].mass == Approx(10 + 10 + 10 + 90));
  CHECK(result[0].point.x() == Approx((10 * 0.5 + 10 * 1.5 + 10 * 2.5 + 90 * 3.5) / 120));
  CHECK(result[0].point.y() == Approx((30 * 0.9 + 90 * 0.7) / 120));
  CHECK(result[0].point.z() == Approx(0.5));
  CHECK((result[0].force - Vector3d(0, 120, 0)).norm() < 1e-12);
}

TEST_CASE("deposit keeps the mass, the density of snow that is there, and gives bare ground that of what comes") {
  Field field = flat_field(1, 4, 0.5, 0.4, 200);
  field.snow(0, 2) = field.snow(0, 3) = 0;
  Amounts arriving = Amounts::none(field.snow);
  arriving.add(0, 1, 1, 5, 0.05);
  arriving.add(0, 2, 1, 5, 0.05);
  arriving.add(0, 2, 1, 15, 0.05);
  const double before = mass(field);
  deposit(field, arriving);
  CHECK(mass(field) == Approx(before + 25));
  CHECK(field.snow(0, 0) == 0.4);
  CHECK(field.density(0, 1) == 200);
  CHECK(field.snow(0, 1) == Approx(0.4 + 5 / (200 * 0.25)));
  CHECK(field.density(0, 2) == Approx(200));
  CHECK(field.snow(0, 2) == Approx(0.4));
  CHECK(field.snow(0, 3) == 0);
}

TEST_CASE("rows are z, columns are x, and x is the faster in memory") {
  Cells cells = Cells::Zero(2, 3);
  cells(1, 2) = 7;
  CHECK(cells.data()[2 + 3 * 1] == 7);
}
