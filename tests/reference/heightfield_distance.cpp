#include "tests/reference/heightfield_distance.h"

#include "tests/catch.h"
#include "tests/reference/fields.h"

using namespace firn::reference;

namespace {
const double kInfinity = std::numeric_limits<double>::infinity();
const Direction kAppendix{FactorRule::appendix, 4};

// Tables as printed: the first row is +z.
using Table = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
Table printed(const Cells& cells) { return cells.colwise().reverse(); }
// To the printed digit.
bool same(const Cells& ours, const Table& table, double digit) {
  CAPTURE(printed(ours), table);
  const bool result = ((printed(ours) - table).abs() <= digit / 2 + 1e-12).all();
  CHECK(result);
  return result;
}

Cells block_of_one() {
  Cells d = Cells::Zero(7, 7);
  d.block(1, 1, 5, 5).setOnes();
  return d;
}

Cells distance_of(const Vector3d& velocity) {
  const Cells d = block_of_one();
  return distance_transform(d, Owners::Zero(7, 7), {step_costs(velocity, kAppendix)});
}

Cells row_distance(double left, double right) {
  Cells d = Cells::Ones(1, 8);
  d(0, 0) = d(0, 7) = 0;
  return distance_transform(d, Owners::Zero(1, 8), {{left, right, kInfinity, kInfinity}});
}
}  // namespace

TEST_CASE("distances along one row are the printed ones [H8]") {
  Table row(1, 8);
  row << 0, 2, 4, 6, 6, 4, 2, 0;
  same(row_distance(2, 2), row, 0.01);
  row << 0, 6, 5, 4, 3, 2, 1, 0;
  same(row_distance(kInfinity, 1), row, 0.01);
  row << 0, 1.33, 2.67, 4, 5.33, 6.67, 4, 0;
  same(row_distance(4.0 / 3, 4), row, 0.01);
}

TEST_CASE("distances in the block are the printed ones [H8]") {
  Table table(5, 5);
  table << 4, 4, 4, 4, 4, 4, 8, 8, 8, 4, 4, 8, 12, 8, 4, 4, 8, 8, 8, 4, 4, 4, 4, 4, 4;
  same(distance_of({0, -1, 0}).block(1, 1, 5, 5), table, 0.1);
  for (int row = 0; row < 5; ++row) table.row(row) << 6.5, 5.2, 3.9, 2.6, 1.3;
  same(distance_of({2, -1, 0}).block(1, 1, 5, 5), table, 0.1);
  table << 1.3, 1.3, 1.3, 1.3, 1.3, 2.6, 2.6, 2.6, 2.6, 1.9, 3.9, 3.9, 3.9, 3.9, 1.9, 5.2, 5.2, 5.2, 3.9, 1.9, 6.6, 6.6, 5.8, 3.9,
      1.9;
  same(distance_of({2, -1, 3}).block(1, 1, 5, 5), table, 0.1);
}

TEST_CASE("amounts pushed out of the block are the printed ones [H8]") {
  const Cells d = block_of_one();
  const Amounts start{d, d};
  Table table(7, 7);
  SECTION("4 neighbours") {
    table << 0, 1.0, 4.3, 2.9, 2.0, 1.0, 0,  //
        1.0, 0, 0, 0, 0, 0, 1.0,             //
        0.9, 0, 0, 0, 0, 0, 1.0,             //
        0.8, 0, 0, 0, 0, 0, 1.9,             //
        0.7, 0, 0, 0, 0, 0, 2.7,             //
        0.3, 0, 0, 0, 0, 0, 0.9,             //
        0, 0.3, 0.3, 0.4, 0.7, 0.9, 0;
    const Amounts out = distribute_distance(start, distance_of({2, -1, 3}), 4);
    same(out.mass, table, 0.1);
    CHECK(out.mass.sum() == Approx(25));
  }
  SECTION("8 neighbours") {
    table << 0.4, 1.4, 2.4, 2.8, 2.1, 1.1, 0.3,  //
        0.8, 0, 0, 0, 0, 0, 0.7,                 //
        1.2, 0, 0, 0, 0, 0, 1.4,                 //
        1.0, 0, 0, 0, 0, 0, 1.8,                 //
        0.7, 0, 0, 0, 0, 0, 1.9,                 //
        0.4, 0, 0, 0, 0, 0, 1.1,                 //
        0.1, 0.3, 0.4, 0.6, 0.8, 0.7, 0.4;
    const Amounts out = distribute_distance(start, distance_of({2, -1, 3}), 8);
    same(out.mass, table, 0.1);
    CHECK(out.mass.sum() == Approx(25));
  }
}

TEST_CASE("the distance of a cell is the least of its neighbours' plus the step, for any footprint and several bodies") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  for (int trial = 0; trial < 20; ++trial) {
    const Cells d = (random_cells(random, 15, 12, -0.3, 1)).max(0);
    Owners owner = Owners::NullaryExpr(15, 12, [&]() { return random.integer(0, 2); });
    std::vector<StepCosts> costs;
    for (int body = 0; body < 3; ++body) {
      costs.push_back({random.uniform(0.5, 9), random.uniform(0.5, 9), random.uniform(0.5, 9), random.uniform(0.5, 9)});
    }
    costs[1].left = kInfinity;
    const Cells distance = distance_transform(d, owner, costs);
    for (int z = 0; z < 15; ++z) {
      for (int x = 0; x < 12; ++x) {
        double least = d(z, x) > 0 ? kInfinity : 0;
        const StepCosts& c = costs[owner(z, x)];
        for (int dz = -1; dz <= 1 && d(z, x) > 0; ++dz) {
          for (int dx = -1; dx <= 1; ++dx) {
            if ((dz == 0 && dx == 0) || !inside(d, z + dz, x + dx)) continue;
            const double a = dx == 0 ? 0 : (dx < 0 ? c.left : c.right), b = dz == 0 ? 0 : (dz < 0 ? c.down : c.up);
            least = std::min(least, distance(z + dz, x + dx) + std::sqrt(a * a + b * b));
          }
        }
        CHECK(distance(z, x) == Approx(least).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("snow leaves the footprint whole wherever there is a way out") {
  const std::uint64_t seed = firn::test::seed();
  INFO("seed " << seed);
  Random random(seed);
  const int neighbors = GENERATE(4, 8);
  Cells d = Cells::Zero(14, 17);
  d.block(2, 3, 9, 11) = random_cells(random, 9, 11, -0.2, 1).max(0);
  const Cells distance = distance_transform(d, Owners::Zero(14, 17), {step_costs({1, -0.4, -0.7}, {FactorRule::thesis, 4})});
  const Amounts out = distribute_distance({d * 100, d * 0.5}, distance, neighbors);
  CHECK(out.mass.sum() == Approx(100 * d.sum()));
  CHECK(out.volume.sum() == Approx(0.5 * d.sum()));
  CHECK((out.mass - 200 * out.volume).abs().maxCoeff() < 1e-11);
  CHECK((d > 0).select(out.mass, 0.0).maxCoeff() == 0);
  // Snow comes to rest on cells that touch the footprint.
  for (int z = 0; z < 14; ++z) {
    for (int x = 0; x < 17; ++x) {
      if (out.mass(z, x) <= 0) continue;
      bool touches = false;
      for (const Offset& step : kNeighbors)
        touches = touches || (inside(d, z + step.z, x + step.x) && d(z + step.z, x + step.x) > 0);
      CHECK(touches);
    }
  }
}

TEST_CASE("snow that has no way out stays where it was") {
  const Cells d = Cells::Ones(3, 4);
  const Cells enclosed = distance_transform(d, Owners::Zero(3, 4), {{1, 1, 1, 1}});
  CHECK((enclosed == kInfinity).all());
  CHECK((distribute_distance({d, d}, enclosed, 8).mass == d).all());
  // Level motion to the right, up to the field's edge: no step is possible.
  Cells edge = Cells::Zero(3, 4);
  edge.block(0, 2, 3, 2).setOnes();
  const Cells stuck = distance_transform(edge, Owners::Zero(3, 4), {step_costs({1, 0, 0}, {FactorRule::thesis, 4})});
  CHECK((distribute_distance({edge, edge}, stuck, 4).mass == edge).all());
}

TEST_CASE("distances within a relative 1e-6 are one level, and hand nothing to each other") {
  CHECK(strictly_lower(1, 1.00001));
  CHECK_FALSE(strictly_lower(1, 1.0000005));
  CHECK_FALSE(strictly_lower(1, 1));
  CHECK_FALSE(strictly_lower(2, 1));
  CHECK(strictly_lower(0, 1e-9));
  CHECK(strictly_lower(1, kInfinity));
  CHECK_FALSE(strictly_lower(kInfinity, kInfinity));
  Cells distance(1, 4);
  distance << 0, 1, 1 + 5e-7, 0;
  Cells amounts(1, 4);
  amounts << 0, 3, 5, 0;
  const Amounts out = distribute_distance({amounts, amounts}, distance, 4);
  CHECK(out.mass(0, 0) == 3);
  CHECK(out.mass(0, 3) == 5);
}
