// Whole steps of material-point snow, and what barriers cost.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/bench.h"

namespace firn::app {
namespace {

constexpr double cell = 0.05;  // of bench/scenes/ball.yaml, m

// A ball of about so many particles in a box of so many nodes along each axis.
std::vector<std::string> ball(double particles, int per_cell, int nodes) {
  const double volume = particles / per_cell * cell * cell * cell;
  const double radius = std::cbrt(3 * volume / (4 * std::numbers::pi));
  const double side = (nodes - 1) * cell;
  return {fmt::format("scene.domain.max=[{0}, {0}, {0}]", side), fmt::format("scene.snow.0.sphere.radius={:.5f}", radius),
          fmt::format("scene.snow.0.sphere.center=[{0}, {0}, {0}]", side / 2), fmt::format("scene.snow.0.per_cell={}", per_cell)};
}

BenchCase ball_case(const std::string& name, const std::string& pipeline, std::vector<std::string> set) {
  return {.name = name, .pipeline = pipeline, .scene = "ball", .set = std::move(set), .per_particle = true};
}

}  // namespace

void bench_step(Bench& bench) {
  const bool small = bench.small();
  const BenchPace pace{.warm_up = 3, .steps = 1, .seconds = small ? 0.1 : 0.4};
  run_in_turn(bench,
              {ball_case("step/mpm_thesis/50000", "mpm_thesis", ball(50000, 8, 100)),
               ball_case("step/mpm_snow/50000", "mpm_snow", ball(50000, 8, 100))},
              pace);

  // [M 5.3]: from 47,063 particles to 16 times as many in 200^3 nodes, the body as large as at first, or growing with them.
  const std::vector<int> factors = small ? std::vector{1, 2, 4} : std::vector{1, 2, 4, 8, 16};
  const int nodes = small ? 100 : 200;
  for (const bool growing : {false, true}) {
    std::vector<BenchCase> cases;
    for (const int factor : factors) {
      const int particles = 47063 * factor;
      BenchCase one = ball_case(fmt::format("step/mpm_snow/{}/{}", growing ? "growing" : "fixed", particles), "mpm_snow",
                                ball(particles, growing ? 8 : 4 * factor, nodes));
      one.series = growing ? "growing body, 8 per cell" : "fixed body, 4 to 64 per cell";
      one.along = "particles";
      one.x = particles;
      cases.push_back(one);
    }
    run_in_turn(bench, cases, pace);
  }

  const auto boxes = [&](const std::string& family, double particles, const std::vector<int>& sizes) {
    std::vector<BenchCase> cases;
    for (const int size : sizes) {
      BenchCase one = ball_case(fmt::format("step/mpm_snow/{}/{}", family, size), "mpm_snow", ball(particles, 8, size));
      one.series = fmt::format("{:.0f} particles", particles);
      one.along = "nodes along each axis";
      one.x = size;
      cases.push_back(one);
    }
    run_in_turn(bench, cases, pace);
  };
  boxes("grid", 47063, small ? std::vector{80, 120} : std::vector{100, 150, 200, 300});
  boxes("box", 50000, small ? std::vector{100, 200, 2000} : std::vector{100, 400, 2000});
}

void bench_two_snowballs(Bench& bench) {
  std::vector<BenchCase> cases;
  for (const std::string pipeline : {"mpm_thesis", "mpm_snow"})
    cases.push_back(
        {.name = "two_snowballs/" + pipeline, .pipeline = pipeline, .scene = "two_snowballs", .set = {}, .per_particle = true});
  run_in_turn(bench, cases, {.warm_up = 3, .steps = 1, .seconds = bench.small() ? 0.1 : 0.4});
}

void bench_barriers(Bench& bench) {
  const auto both = [&](const std::string& name, const BenchCase& one, const BenchPace& pace) {
    std::vector<BenchCase> cases{one, one};
    cases[0].name = "barriers/" + name + "/derived";
    cases[1].name = "barriers/" + name + "/all";
    cases[1].barriers_all = true;
    run_in_turn(bench, cases, pace);
  };
  both("heightfield_contour", {.name = "", .pipeline = "heightfield_contour", .scene = "field", .set = {}},
       {.warm_up = 5, .steps = 10});
  both("mpm_snow", ball_case("", "mpm_snow", ball(50000, 8, 100)), {.warm_up = 3, .steps = bench.small() ? 2 : 10});
}

}  // namespace firn::app
