#include "scene/sampling.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <ctime>
#include <map>
#include <numbers>
#include <random>

#include "scene/npy.h"
#include "scene/repeatable.h"
#include "scene/solid.h"
#include "tests/scene/support.h"

namespace firn::test {

namespace {

using Eigen::Vector3d;
using scene::Particles;

std::string scene_text(const std::string& snow, std::uint64_t scene_seed = 1, double cell = 0.05) {
  return "firn: 1\nseed: " + std::to_string(scene_seed) +
         "\ndomain: {min: [-0.5, 0, 0], max: [1.5, 2, 2], cell: " + std::to_string(cell) +
         "}\nmaterials: {snow: {density: 250}}\nsnow: [" + snow + "]\n";
}
Particles particles_of(const std::string& snow, std::uint64_t scene_seed = 1, double cell = 0.05) {
  return scene::sample(good_scene(scene_text(snow, scene_seed, cell)));
}

using Cell = std::array<int, 3>;
std::map<Cell, std::vector<Vector3d>> by_cell(const Particles& particles, double cell) {
  std::map<Cell, std::vector<Vector3d>> cells;
  for (const Vector3d& position : particles.position) {
    const Vector3d scaled = (position - Vector3d(-0.5, 0, 0)) / cell;
    const Vector3d low = scaled.array().floor();
    cells[{static_cast<int>(low.z()), static_cast<int>(low.y()), static_cast<int>(low.x())}].push_back(scaled - low);
  }
  return cells;
}

bool same_bytes(const Particles& a, const Particles& b) {
  const auto same = [](const auto& left, const auto& right) {
    return left.size() == right.size() && std::memcmp(left.data(), right.data(), left.size() * sizeof(left[0])) == 0;
  };
  return same(a.position, b.position) && same(a.velocity, b.velocity) && same(a.mass, b.mass) && same(a.volume, b.volume) &&
         same(a.material, b.material);
}

double total(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

}  // namespace

TEST_CASE("mass and volume of filled shapes are within 1 % of the shapes'") {
  const std::uint64_t scene_seed = seed() >> 2;
  INFO("seed " << scene_seed);
  constexpr double pi = std::numbers::pi;
  const struct {
    const char* snow;
    double volume;
  } shapes[] = {
      {"{sphere: {center: [0.5, 1, 1.03], radius: 0.4}, material: snow}", 4.0 / 3 * pi * 0.4 * 0.4 * 0.4},
      {"{sphere: {center: [0.5, 1, 1.03], radius: 0.4}, material: snow, per_cell: 5}", 4.0 / 3 * pi * 0.4 * 0.4 * 0.4},
      {"{box: {center: [0.51, 1.02, 1], size: [0.7, 0.53, 0.61]}, material: snow, orientation: {axis: [1, 2, 3], degrees: 40}}",
       0.7 * 0.53 * 0.61},
      {"{capsule: {from: [0.2, 0.7, 0.8], to: [0.8, 1.2, 1], radius: 0.3}, material: snow, per_cell: 27}",
       pi * 0.3 * 0.3 * (std::sqrt(0.36 + 0.25 + 0.04) + 4.0 / 3 * 0.3)}};
  for (const auto& shape : shapes) {
    INFO(shape.snow);
    const Particles particles = particles_of(shape.snow, scene_seed);
    CHECK(total(particles.volume) == Approx(shape.volume).epsilon(0.01));
    CHECK(total(particles.mass) == Approx(250 * shape.volume).epsilon(0.01));
  }
}

TEST_CASE("every full cell holds exactly per_cell particles, one in each of its sub-cells") {
  for (const int per_cell : {1, 2, 3, 4, 5, 6, 7, 8, 12, 27, 60, 64}) {
    INFO(per_cell);
    const Particles particles = particles_of(
        "{box: {min: [0, 0.5, 0.5], max: [0.4, 0.8, 1]}, material: snow, per_cell: " + std::to_string(per_cell) + "}", 5, 0.1);
    const auto cells = by_cell(particles, 0.1);
    REQUIRE(cells.size() == 4 * 3 * 5);
    const std::array<int, 3> factors = scene::sub_cells(per_cell);
    for (const auto& [cell, places] : cells) {
      REQUIRE(places.size() == static_cast<std::size_t>(per_cell));
      std::array<int, 3> counts = factors;
      std::sort(counts.begin(), counts.end());
      bool stratified = false;
      do {
        std::map<Cell, int> hits;
        for (const Vector3d& place : places)
          ++hits[{static_cast<int>(place.x() * counts[0]), static_cast<int>(place.y() * counts[1]),
                  static_cast<int>(place.z() * counts[2])}];
        stratified = stratified || hits.size() == places.size();
      } while (std::next_permutation(counts.begin(), counts.end()));
      CHECK(stratified);
    }
  }
}

TEST_CASE("cells are cut as nearly to cubes as the number allows") {
  const struct {
    int n;
    std::array<int, 3> factors;
  } expected[] = {{1, {1, 1, 1}},  {2, {2, 1, 1}},  {4, {2, 2, 1}},  {7, {7, 1, 1}},  {8, {2, 2, 2}},
                  {12, {3, 2, 2}}, {27, {3, 3, 3}}, {30, {5, 3, 2}}, {36, {4, 3, 3}}, {64, {4, 4, 4}}};
  for (const auto& each : expected) {
    INFO(each.n);
    CHECK(scene::sub_cells(each.n) == each.factors);
  }
  for (int n = 1; n <= 64; ++n) {
    const std::array<int, 3> factors = scene::sub_cells(n);
    CHECK(factors[0] * factors[1] * factors[2] == n);
  }
}

TEST_CASE("slices of a prime number are dealt to all three axes alike") {
  const Particles particles = particles_of("{box: {min: [0, 0.5, 0.5], max: [1, 1.5, 1.5]}, material: snow, per_cell: 7}", 3, 0.1);
  std::array<int, 3> sliced{0, 0, 0};
  for (const auto& [cell, places] : by_cell(particles, 0.1)) {
    for (int axis = 0; axis < 3; ++axis) {
      std::map<int, int> hits;
      for (const Vector3d& place : places) ++hits[static_cast<int>(place[axis] * 7)];
      if (hits.size() == 7) ++sliced[static_cast<std::size_t>(axis)];
    }
  }
  for (const int count : sliced) CHECK(count > 250);  // of 1000 cells
}

TEST_CASE("the same seed gives the same bytes, another seed others") {
  const std::string snow = "{sphere: {center: [0.5, 1, 1], radius: 0.3}, material: snow, velocity: [1, 2, 3], spin: [0, 1, 0]}";
  CHECK(same_bytes(particles_of(snow, 7), particles_of(snow, 7)));
  CHECK_FALSE(same_bytes(particles_of(snow, 7), particles_of(snow, 8)));
}

TEST_CASE("the particles of a seed are these on every machine") {
  const Particles particles = particles_of(
      "{sphere: {center: [0.5, 1, 1], radius: 0.3}, material: snow, spin: [0.3, 0.7, 1.1]}, {box: {min: [0, 0.5, 0.5], max: [0.4, "
      "0.8, 1]}, material: "
      "snow, per_cell: 7}",
      42);
  std::uint64_t digest = 0;
  for (const auto* vectors : {&particles.position, &particles.velocity})
    for (const Vector3d& vector : *vectors)
      for (int axis = 0; axis < 3; ++axis) digest = scene::hash({digest, std::bit_cast<std::uint64_t>(vector[axis])});
  CHECK(particles.position.size() == 10633);
  CHECK(digest == 0xaa58d9427297b50d);
}

TEST_CASE("two equal pieces of snow are not filled alike") {
  const std::string one = "{box: {min: [0, 0.5, 0.5], max: [0.4, 0.8, 1]}, material: snow}";
  const Particles particles = particles_of(one + ", " + one, 1, 0.1);
  const std::size_t half = particles.position.size() / 2;
  REQUIRE(particles.position.size() == 2 * half);
  for (std::size_t i = 0; i < half; ++i) CHECK(particles.position[i] != particles.position[half + i]);
}

TEST_CASE("particles come by ascending cell: z, then y, then x") {
  const Particles particles = particles_of("{sphere: {center: [0.5, 1, 1], radius: 0.3}, material: snow, per_cell: 3}");
  std::vector<Cell> cells;
  for (const Vector3d& position : particles.position) {
    const Vector3d low = ((position - Vector3d(-0.5, 0, 0)) / 0.05).array().floor();
    cells.push_back({static_cast<int>(low.z()), static_cast<int>(low.y()), static_cast<int>(low.x())});
  }
  CHECK(std::is_sorted(cells.begin(), cells.end()));
}

TEST_CASE("jitter is even: the mean place in a sub-cell is its middle, along every axis") {
  const Particles particles = particles_of("{box: {min: [0, 0.5, 0.5], max: [1, 1.5, 1.5]}, material: snow, per_cell: 8}", 11, 0.1);
  REQUIRE(particles.position.size() == 8000);
  for (int axis = 0; axis < 3; ++axis) {
    double sum = 0, squares = 0;
    for (const Vector3d& position : particles.position) {
      const double place = (position[axis] + 0.5) / 0.05, jitter = place - std::floor(place);  // 0.5: a whole number of sub-cells
      sum += jitter;
      squares += jitter * jitter;
    }
    CHECK(sum / 8000 == Approx(0.5).margin(0.02));  // 6 standard deviations
    CHECK(squares / 8000 == Approx(1.0 / 3).margin(0.02));
  }
}

TEST_CASE("a spinning shape turns about its centre") {
  const Particles particles =
      particles_of("{sphere: {center: [0.5, 1, 1], radius: 0.3}, material: snow, velocity: [1, 0, 0], spin: [0, 0, 2]}");
  REQUIRE_FALSE(particles.position.empty());
  for (std::size_t i = 0; i < particles.position.size(); ++i) {
    const Vector3d arm = particles.position[i] - Vector3d(0.5, 1, 1);
    CHECK((particles.velocity[i] - Vector3d(1 - 2 * arm.y(), 2 * arm.x(), 0)).norm() < 1e-12);
  }
}

TEST_CASE("the estimate is an upper bound, and not far off") {
  for (const char* snow :
       {"{sphere: {center: [0.5, 1, 1.03], radius: 0.4}, material: snow}",
        "{sphere: {center: [0.5, 1, 1.03], radius: 0.02}, material: snow, per_cell: 64}",
        "{box: {min: [0, 0.5, 0.5], max: [1, 1.5, 1.5]}, material: snow, per_cell: 7}",
        "{box: {center: [0.5, 1, 1], size: [1, 0.1, 0.1]}, material: snow, orientation: {axis: [1, 2, 3], degrees: 40}}",
        "{capsule: {from: [0.2, 0.7, 0.8], to: [0.8, 1.2, 1], radius: 0.1}, material: snow}"}) {
    INFO(snow);
    const scene::Scene scene = good_scene(scene_text(snow));
    const std::size_t made = scene::sample(scene).position.size();
    const std::uint64_t estimated = scene::estimate_particles(scene);
    CHECK(estimated >= made);
    CHECK(static_cast<double>(estimated) <= 3 * static_cast<double>(made) + 600);
  }
}

TEST_CASE("points keep their places and take velocity, spin about their mean, and what the file adds") {
  const TemporaryFolder folder;
  const std::vector<float> rows{0.25F, 1, 1, 0, 0, 5, 0.75F, 1, 1, 0, 0, 6};
  scene::write_npy(folder / "p.npy", {2, 6}, std::span<const float>(rows));
  const scene::Scene scene =
      good_scene(scene_text("{points: {file: p.npy, mass: 0.5}, material: snow, velocity: [1, 0, 0], spin: [0, 0, 4]}"),
                 folder / "scene.yaml");
  const Particles particles = scene::sample(scene);
  REQUIRE(particles.position.size() == 2);
  CHECK(scene::estimate_particles(scene) == 2);
  CHECK(particles.position[1] == Vector3d(0.75, 1, 1));
  CHECK((particles.velocity[0] - Vector3d(1, -1, 5)).norm() < 1e-12);
  CHECK((particles.velocity[1] - Vector3d(1, 1, 6)).norm() < 1e-12);
  CHECK(particles.mass[0] == 0.5);
  CHECK(particles.volume[0] == Approx(0.5 / 250).epsilon(1e-12));
}

TEST_CASE("points that are not finite, lie outside, or have gone are errors at the snow that names them") {
  const TemporaryFolder folder;
  const auto sampled = [&](std::vector<double> rows) -> std::string {
    scene::write_npy(folder / "p.npy", {rows.size() / 3, 3}, std::span<const double>(rows));
    const scene::Scene scene = good_scene(scene_text("{points: {file: p.npy, mass: 0.5}, material: snow}"), folder / "scene.yaml");
    if (rows.empty()) std::filesystem::remove(folder / "p.npy");
    if (rows.size() == 9) std::filesystem::remove(folder / "p.npy");
    try {
      scene::sample(scene);
    } catch (const config::InputError& error) {
      CHECK(error.diagnostics().all().at(0).place.line == 5);
      return error.what();
    }
    return "";
  };
  CHECK(sampled({0.5, 1, 1, 0.5, 1, 1}).empty());
  CHECK(sampled({0.5, 1, 1, 0.5, std::nan(""), 1}).find("row 1, column 1") != std::string::npos);
  CHECK(sampled({0.5, 1, 1, 0.5, 1, HUGE_VAL}).find("row 1, column 2") != std::string::npos);
  CHECK(sampled({0.5, 1, 1, 0.5, 1, 1.95}).find("1 of 2 points") != std::string::npos);  // margin of 2 cells below 2
  CHECK(sampled({0.5, 1, 1, 0.5, 1, 1, 0.5, 1, 1}).find("does not exist") != std::string::npos);
}

TEST_CASE("random numbers are SplitMix64's") {
  // The first numbers of that generator from the state 1234567, as published with its reference implementation.
  constexpr std::uint64_t state = 1234567;
  CHECK(scene::mix(state + 1 * scene::golden_gamma) == 6457827717110365317U);
  CHECK(scene::mix(state + 2 * scene::golden_gamma) == 3203168211198807973U);
  CHECK(scene::mix(state + 3 * scene::golden_gamma) == 9817491932198370423U);
  CHECK(scene::unit_interval(0) == 0);
  CHECK(scene::unit_interval(~std::uint64_t{0}) == 1 - 0x1p-53);
  CHECK(scene::hash({1, 2}) != scene::hash({2, 1}));
  CHECK(scene::hash({1}) != scene::hash({1, 0}));
}

TEST_CASE("the distance from a solid is zero inside and grows no faster than the way", "[scene]") {
  std::mt19937_64 random(seed());
  INFO("seed " << seed());
  std::uniform_real_distribution<double> anywhere(-2, 2);
  const auto point = [&] { return Vector3d(anywhere(random), anywhere(random), anywhere(random)); };
  const scene::SolidShape shapes[] = {scene::Sphere{point(), 0.7}, scene::Box{point(), {0.3, 0.8, 0.5}},
                                      scene::Capsule{point(), point(), 0.2}};
  for (const scene::SolidShape& shape : shapes) {
    const scene::Inside inside(scene::Solid{shape, Eigen::Quaterniond(Eigen::AngleAxisd(1, point().normalized()))});
    CAPTURE(scene::name_of(shape));
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vector3d a = point(), b = point();
      hits += inside(a) ? 1 : 0;
      CHECK((inside.distance(a) == 0) == inside(a));
      CHECK(std::abs(inside.distance(a) - inside.distance(b)) <= (a - b).norm() + 1e-12);
    }
    CHECK(hits > 0);
  }
}

TEST_CASE("a thin solid askew in a large domain is sampled in a moment", "[scene]") {
  const std::string text =
      "firn: 1\ndomain: {min: [0, 0, 0], max: [5.12, 5.12, 5.12], cell: 0.02}\nsnow: [{capsule: {from: [0.1, 0.1, 0.1], "
      "to: [5, 5, 5], radius: 0.002}, material: packed, per_cell: 64}]\n";
  const scene::Scene scene = good_scene(text);
  const std::clock_t start = std::clock();
  const Particles particles = scene::sample(scene);
  CHECK(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC < 2);
  // pi r^2 l and two half spheres, in sub-cells.
  const double expected = (3.14159265 * 0.002 * 0.002 * (4.9 * std::sqrt(3.0) + 4.0 / 3.0 * 0.002)) / (8e-6 / 64);
  CHECK(static_cast<double>(particles.position.size()) == Approx(expected).epsilon(0.2));
}

}  // namespace firn::test
