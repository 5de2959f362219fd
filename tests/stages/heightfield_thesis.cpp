// Where the thesis of the height field is wrong or silent, what Firn does instead: one small case each, on the GPU.

#include "tests/stages/random_field.h"

using namespace firn::test;

namespace {

const float infinite = std::numeric_limits<float>::infinity();

Arrays run(const std::string& name, const std::string& options, int rows, int columns, Arrays in, std::uint64_t bodies = 1,
           double h = 1) {
  StageRun run;
  run.stage = name;
  run.options = options;
  run.environment = field_environment(rows, columns, h, bodies);
  run.in = std::move(in);
  return run_stage(run);
}

// One covered cell in the middle of 5 x 5.
Arrays one_cell(const std::vector<float>& velocity) {
  Arrays in;
  in.floats["overlap"] = std::vector<float>(25, 0.0f);
  in.integers["owner"] = std::vector<std::int32_t>(25, -1);
  in.floats["overlap"][12] = 1;
  in.integers["owner"][12] = 0;
  in.floats["body_velocity"] = velocity;
  return in;
}

}  // namespace

TEST_CASE("all eight neighbours are on the contour, where H 3.21 prints y+i for y+j") {
  const Arrays out = run("heightfield.contour", "{}", 5, 5, one_cell({0, -1, 0}));
  for (int z = 0; z < 5; ++z)
    for (int x = 0; x < 5; ++x) {
      CAPTURE(z, x);
      const bool beside = std::max(std::abs(z - 2), std::abs(x - 2)) == 1;
      CHECK(out.integers.at("contour_owner").at(static_cast<std::size_t>(5 * z + x)) == (beside ? 0 : -1));
    }
}

TEST_CASE("contour directions point outward, where the printed signs of H 3.22 point inward") {
  const std::vector<float> weight = run("heightfield.contour", "{}", 5, 5, one_cell({1, 0, 0})).floats.at("contour_weight");
  CHECK(weight.at(13) == Approx(1));              // ahead, at +x
  CHECK(weight.at(8) == Approx(std::sqrt(0.5)));  // ahead and aside
  CHECK(weight.at(11) == 0.0f);                   // behind
}

TEST_CASE("the gradient of the overlap has the weights 1 2 1, which the thesis's code leaves out") {
  Arrays in = one_cell({1, 0, 0});
  in.floats["overlap"][17] = 1;  // two cells in a column: rows 2 and 3
  in.integers["owner"][17] = 0;
  const std::vector<float> weight = run("heightfield.contour", "{}", 5, 5, in).floats.at("contour_weight");
  // Right of the upper cell: 2 from its own row, 1 from the next one, whose z share is 1: (3, -1) / sqrt(10).
  CHECK(weight.at(13) == Approx(3 / std::sqrt(10.0)));
}

TEST_CASE("resistance is a force: momentum per time, where H 3.8 has the unit of a momentum") {
  Arrays in = one_cell({0, -3, 0});
  in.floats["density"] = std::vector<float>(25, 200.0f);
  const float one = run("heightfield.resistance", "{}", 5, 5, in).floats.at("resistance").at(1);
  const float half = run("heightfield.resistance", "{time_constant: 2}", 5, 5, in).floats.at("resistance").at(1);
  CHECK(one == Approx(200 * 3));  // 1 m3 of 200 kg/m3 at 3 m/s within 1 s
  CHECK(half == Approx(100 * 3));
}

TEST_CASE("snow under a body keeps its mass, where H 3.11 loses some of it") {
  Arrays in;
  in.floats = {{"overlap", {0.2f}}, {"depth", {0.5f}}, {"density", {200.0f}}};
  const auto mass = [](const Arrays& out) {
    return static_cast<double>(out.floats.at("depth").at(0)) * static_cast<double>(out.floats.at("density").at(0)) +
           static_cast<double>(out.floats.at("displaced").at(0));
  };
  CHECK(mass(run("heightfield.compress", "{}", 1, 1, in)) == Approx(100).epsilon(1e-6));
  CHECK(std::abs(mass(run("heightfield.compress", "{model: thesis}", 1, 1, in)) - 100) > 1);
}

TEST_CASE("snow that would be pressed beyond its greatest density is pushed away instead") {
  Arrays in;
  in.floats = {{"overlap", {0.45f}}, {"depth", {0.5f}}, {"density", {100.0f}}};
  const Arrays out = run("heightfield.compress", "{}", 1, 1, in);
  CHECK(out.floats.at("density").at(0) == Approx(500));
  CHECK(out.floats.at("displaced").at(0) == Approx(50 - 0.05 * 500).epsilon(1e-5));
}

TEST_CASE("a body on the ground pushes all of the snow away") {
  Arrays in;
  in.floats = {{"overlap", {0.5f}}, {"depth", {0.5f}}, {"density", {100.0f}}};
  const Arrays out = run("heightfield.compress", "{}", 1, 1, in);
  CHECK(out.floats.at("depth").at(0) == 0.0f);
  CHECK(out.floats.at("displaced").at(0) == Approx(50));
}

TEST_CASE("a pillar gives the mean of its excesses, where algorithm 4.11 takes their sum") {
  Arrays in;
  in.floats["ground"] = std::vector<float>(25, 0.0f);
  in.floats["depth"] = std::vector<float>(25, 0.0f);
  in.floats["depth"][12] = 1;
  in.floats["density"] = std::vector<float>(25, 100.0f);
  in.floats["underside"] = std::vector<float>(25, infinite);
  const std::vector<float> depth =
      run("heightfield.flatten", "{slope: 0.6, diagonal: thesis}", 5, 5, in, 0, 0.5).floats.at("depth");
  CHECK(depth.at(12) == Approx(1 - 0.7));
  CHECK(depth.at(13) == Approx(0.7 / 8));
  const std::vector<float> euclidean = run("heightfield.flatten", "{slope: 0.6}", 5, 5, in, 0, 0.5).floats.at("depth");
  CHECK(euclidean.at(12) == Approx(0.3 * (1 + std::sqrt(2.0)) / 2));
  double sum = 0;
  for (const float d : depth) sum += d;
  CHECK(sum == Approx(1).epsilon(1e-6));
}
