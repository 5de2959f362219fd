// Steps of the height field, drawing not counted.

#include <fmt/format.h>

#include "app/bench.h"

namespace firn::app {
namespace {

BenchCase field_case(const std::string& method, int cells, const std::string& bodies, const std::string& scene) {
  BenchCase one{.name = fmt::format("heightfield/{}/{}/{}", method, cells, bodies),
                .pipeline = "heightfield_" + method,
                .scene = scene,
                .set = {fmt::format("scene.field.cells=[{0}, {0}]", cells)}};
  one.series = fmt::format("{}, {}", method, bodies == "1" ? "1 body" : bodies + " bodies");
  one.along = "cells along each axis";
  one.x = cells;
  return one;
}

// Boxes side by side that make up one block of 5 m by 4 m, half way in the snow and moving slowly.
std::string blocks(int along_x, int along_z) {
  std::string list;
  const double x = 5.0 / along_x, z = 4.0 / along_z;
  for (int i = 0; i < along_x; ++i)
    for (int k = 0; k < along_z; ++k)
      list += fmt::format("{}{{box: {{size: [{:.6f}, 0.4, {:.6f}]}}, position: [{:.6f}, 0.4, {:.6f}], velocity: [0.2, 0, 0]}}",
                          list.empty() ? "" : ", ", x, z, 2 + (i + 0.5) * x, 3 + (k + 0.5) * z);
  return "scene.bodies=[" + list + "]";
}

}  // namespace

void bench_heightfield(Bench& bench) {
  const bool small = bench.small();
  const BenchPace pace = small ? BenchPace{.warm_up = 10, .steps = 6} : BenchPace{.warm_up = 60, .steps = 60};
  for (const int cells : small ? std::vector{256, 512} : std::vector{256, 512, 1024, 2048, 4096})
    for (const auto& [bodies, scene] : {std::pair{"1", "field"}, {"500", "stones"}})
      run_in_turn(bench, {field_case("contour", cells, bodies, scene), field_case("distance", cells, bodies, scene)}, pace, true);

  const int cells = small ? 256 : 1024;
  std::vector<BenchCase> same;
  for (const auto& [count, along_x, along_z] : {std::tuple{1, 1, 1}, {500, 25, 20}}) {
    BenchCase one{.name = fmt::format("heightfield/footprint/{}/{}", cells, count),
                  .pipeline = "heightfield_contour",
                  .scene = "field",
                  .set = {fmt::format("scene.field.cells=[{0}, {0}]", cells), blocks(along_x, along_z)}};
    same.push_back(one);
  }
  run_in_turn(bench, same, pace);
}

}  // namespace firn::app
