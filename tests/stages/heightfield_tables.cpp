// The tables that the thesis prints for the height field [H8], from the GPU, to the printed digit.

#include "tests/stages/random_field.h"

using namespace firn::test;
namespace ref = firn::reference;

namespace {

const float infinite = std::numeric_limits<float>::infinity();

struct Block {
  int rows = 7, columns = 7;
  std::vector<float> overlap;
  std::vector<std::int32_t> owner;
};
// D = 1 in all cells but those at the border.
Block block_of_one() {
  Block b;
  for (int z = 0; z < 7; ++z)
    for (int x = 0; x < 7; ++x) {
      const bool covered = z > 0 && z < 6 && x > 0 && x < 6;
      b.overlap.push_back(covered ? 1.0f : 0.0f);
      b.owner.push_back(covered ? 0 : -1);
    }
  return b;
}

std::vector<float> distance_of(const Block& b, const std::vector<float>& velocity, const std::string& options) {
  StageRun run;
  run.stage = "heightfield.distance_transform";
  run.options = options;
  run.environment = field_environment(b.rows, b.columns, 1.0, 1);
  run.in.floats = {{"overlap", b.overlap}, {"body_velocity", velocity}};
  run.in.integers = {{"owner", b.owner}};
  return run_stage(run).floats.at("distance");
}
const char* appendix = "{direction: appendix, k: 4}";

std::vector<float> pushed_out(const std::vector<float>& distance, const char* neighbours) {
  StageRun run;
  run.stage = "heightfield.distribute_distance";
  run.options = std::string("{neighbours: ") + neighbours + "}";
  run.environment = field_environment(7, 7, 1.0, 1);
  run.in.floats = {{"distance", distance}, {"displaced", block_of_one().overlap}};
  return run_stage(run).floats.at("arrived");
}

// `printed`: rows from +z down, as the thesis prints them; `margin` cells left out around.
void check_table(const std::vector<float>& cells, int margin, const std::vector<double>& printed, double digit) {
  const int side = 7 - 2 * margin;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      CAPTURE(row, column);
      const double ours = cells.at(static_cast<std::size_t>((6 - margin - row) * 7 + margin + column));
      CHECK(std::abs(ours - printed.at(static_cast<std::size_t>(row * side + column))) <= digit / 2 + 1e-6);
    }
}

}  // namespace

TEST_CASE("distances in the block from the GPU are the printed ones [H8]") {
  const Block b = block_of_one();
  check_table(distance_of(b, {0, -1, 0}, appendix), 1, {4, 4, 4, 4, 4, 4, 8, 8, 8, 4, 4, 8, 12, 8, 4, 4, 8, 8, 8, 4, 4, 4, 4, 4, 4},
              0.1);
  std::vector<double> rows;
  for (int row = 0; row < 5; ++row) rows.insert(rows.end(), {6.5, 5.2, 3.9, 2.6, 1.3});
  check_table(distance_of(b, {2, -1, 0}, appendix), 1, rows, 0.1);
  check_table(distance_of(b, {2, -1, 3}, appendix), 1, {1.3, 1.3, 1.3, 1.3, 1.3, 2.6, 2.6, 2.6, 2.6, 1.9, 3.9, 3.9, 3.9,
                                                        3.9, 1.9, 5.2, 5.2, 5.2, 3.9, 1.9, 6.6, 6.6, 5.8, 3.9, 1.9},
              0.1);
}

TEST_CASE("distances along one row from the GPU are those of its two costs [H8]") {
  // A row of 8 cells of which 6 are covered. Costs (left, right) come from the motion: 1/s with s of the appendix's rule.
  Block b{1, 8, {0, 1, 1, 1, 1, 1, 1, 0}, {-1, 0, 0, 0, 0, 0, 0, -1}};
  SECTION("costs 2 and 2: straight down, k = 2") {
    const std::vector<float> expected = {0, 2, 4, 6, 6, 4, 2, 0};
    CHECK(relative_error(distance_of(b, {0, -1, 0}, "{direction: appendix, k: 2}"), expected) <= 1e-5);
  }
  SECTION("costs infinite and 1: level to the right") {
    const std::vector<float> expected = {0, 6, 5, 4, 3, 2, 1, 0};
    CHECK(relative_error(distance_of(b, {3, 0, 0}, appendix), expected) <= 1e-5);
  }
  SECTION("costs 4/3 and 4") {
    // s = 3/4 to the left and 1/4 to the right: r/k = 1/4 and d^(3/2) = 1/2.
    const double d = std::pow(0.5, 2.0 / 3), r = 1 - d;
    const std::string options = "{direction: appendix, k: " + std::to_string(4 * r) + "}";
    const std::vector<float> velocity = {static_cast<float>(-std::sqrt(d)), static_cast<float>(-std::sqrt(r)), 0};
    const std::vector<double> printed = {0, 1.33, 2.67, 4, 5.33, 6.67, 4, 0};
    const std::vector<float> ours = distance_of(b, velocity, options);
    for (std::size_t i = 0; i < printed.size(); ++i) CHECK(std::abs(ours[i] - printed[i]) <= 0.005 + 1e-6);
  }
}

TEST_CASE("amounts pushed out of the block by the GPU are the printed ones [H8]") {
  const std::vector<float> distance = distance_of(block_of_one(), {2, -1, 3}, appendix);
  const std::vector<float> four = pushed_out(distance, "4");
  check_table(four, 0, {0, 1.0, 4.3, 2.9, 2.0, 1.0, 0, 1.0, 0, 0,   0,   0, 0, 1.0, 0.9, 0, 0,   0, 0,   0,   1.0, 0.8, 0,   0, 0,
                        0, 0,   1.9, 0.7, 0,   0,   0, 0,   0, 2.7, 0.3, 0, 0, 0,   0,   0, 0.9, 0, 0.3, 0.3, 0.4, 0.7, 0.9, 0},
              0.1);
  const std::vector<float> eight = pushed_out(distance, "8");
  check_table(eight, 0,
              {0.4, 1.4, 2.4, 2.8, 2.1, 1.1, 0.3, 0.8, 0, 0,   0,   0, 0, 0.7, 1.2, 0, 0,   0,   0,   0,   1.4, 1.0, 0,   0,  0,
               0,   0,   1.8, 0.7, 0,   0,   0,   0,   0, 1.9, 0.4, 0, 0, 0,   0,   0, 1.1, 0.1, 0.3, 0.4, 0.6, 0.8, 0.7, 0.4},
              0.1);
  for (const std::vector<float>& all : {four, eight}) {
    double sum = 0;
    for (const float amount : all) sum += amount;
    CHECK(sum == Approx(25).epsilon(1e-6));
  }
}

TEST_CASE("a body that does not move sideways by any rule: distances stay finite, without motion too") {
  const Block b = block_of_one();
  const std::vector<float> resting = distance_of(b, {0, 0, 0}, appendix);
  CHECK(resting.at(8) == 4.0f);
  CHECK(resting.at(24) == 12.0f);
  Block all = b;
  std::fill(all.overlap.begin(), all.overlap.end(), 1.0f);
  std::fill(all.owner.begin(), all.owner.end(), 0);
  for (const float d : distance_of(all, {0, -1, 0}, appendix)) CHECK(d == infinite);  // nowhere to go
}
