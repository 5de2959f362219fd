// What emitters bring is spread evenly and independently, and each brings its own material.

#include <algorithm>
#include <numbers>

#include "scene/emission.h"
#include "tests/scene/support.h"

namespace firn::test {

namespace {

using Eigen::Vector3d;

// `light` weighs 100 * 0.05^3 / 8 kg a particle; `heavy` three times as much a volume, in twice as many particles.
const std::string text = R"(firn: 1
name: spread
seed: 3
time: {dt: 1.0e-3, fps: 50, end: 2.0}
gravity: [0, -10, 0]
domain: {min: [0, 0, 0], max: [2, 1.5, 1], cell: 0.05}
materials:
  light: {preset: new_snow, density: 100}
  heavy: {preset: packed, density: 300}
emitters:
  - {snowfall: {center: [1, 1, 0.5], size: [1, 0.5], rate: 2, velocity: [0.5, -1, 0]}, material: light}
  - {gun: {position: [0.4, 0.5, 0.5], direction: [1, 0, 0], speed: 4, spread: 10, radius: 0.1, rate: 2}, material: heavy, per_cell: 16}
  - {gun: {position: [0.4, 0.5, 0.5], direction: [1, 0, 0], speed: 4, spread: 10, radius: 0.1, rate: 2}, material: heavy, per_cell: 16}
max_particles: 5000
)";

struct Departure {
  Vector3d position, velocity;
};

// Of the first `count` particles of an emitter: their flight undone.
std::vector<Departure> departures(const scene::Scene& scene, std::size_t emitter, std::uint64_t count) {
  const double time = 10, rate = scene::particles_per_second(scene, scene.emitters[emitter]);
  const scene::Particles flown = scene::emitted(scene, emitter, 0, count, time);
  std::vector<Departure> result;
  for (std::size_t i = 0; i < count; ++i) {
    const double age = time - (static_cast<double>(i) + 0.5) / rate;
    const Vector3d velocity = flown.velocity[i] - age * scene.gravity;
    result.push_back({flown.position[i] - age * velocity - 0.5 * age * age * scene.gravity, velocity});
  }
  return result;
}

// Share of a whole turn, from 0 to 1.
double turn(double along, double across) { return std::atan2(along, across) / (2 * std::numbers::pi) + 0.5; }

// Rows of numbers that are uniform in 0 to 1 and independent: any two of them fill a square of 4 x 4 fields evenly.
void check_even(const std::vector<std::vector<double>>& rows) {
  for (std::size_t a = 0; a < rows.size(); ++a)
    for (std::size_t b = a + 1; b < rows.size(); ++b) {
      CAPTURE(a, b);
      std::array<int, 16> fields{};
      for (std::size_t i = 0; i < rows[a].size(); ++i) {
        REQUIRE((rows[a][i] > -1e-9 && rows[a][i] < 1 + 1e-9 && rows[b][i] > -1e-9 && rows[b][i] < 1 + 1e-9));
        const auto field = [&](double share) { return static_cast<std::size_t>(std::clamp(std::floor(share * 4), 0.0, 3.0)); };
        ++fields[4 * field(rows[a][i]) + field(rows[b][i])];
      }
      const double expected = static_cast<double>(rows[a].size()) / 16;
      for (const int count : fields) CHECK(std::abs(count - expected) < 5 * std::sqrt(expected));
    }
}

}  // namespace

TEST_CASE("a snowfall comes evenly from its whole area") {
  const scene::Scene scene = good_scene(text);
  std::vector<std::vector<double>> shares(2);
  for (const Departure& each : departures(scene, 0, 4000)) {
    shares[0].push_back(each.position.x() - 1 + 0.5);
    shares[1].push_back((each.position.z() - 0.5) / 0.5 + 0.5);
  }
  check_even(shares);
}

TEST_CASE("a gun fires evenly from its whole nozzle and into its whole cone, one independent of the other") {
  const scene::Scene scene = good_scene(text);
  const double cone = 1 - std::cos(10 * std::numbers::pi / 180);
  std::vector<std::vector<double>> shares(4);
  for (const Departure& each : departures(scene, 1, 4000)) {
    const Vector3d place = each.position - Vector3d(0.4, 0.5, 0.5), direction = each.velocity / 4;
    shares[0].push_back(place.squaredNorm() / 0.01);
    shares[1].push_back(turn(place.y(), place.z()));
    shares[2].push_back((1 - direction.x()) / cone);
    shares[3].push_back(turn(direction.y(), direction.z()));
  }
  check_even(shares);
}

TEST_CASE("a gun fires where it points, whichever way that is") {
  for (const char* direction : {"[0, 1, 0]", "[0, -1, 0]", "[-1, 2, 3]", "[0, 0, -1]"}) {
    CAPTURE(direction);
    std::string turned = text;
    for (std::size_t at = 0; (at = turned.find("direction: [1, 0, 0]")) != std::string::npos;)
      turned.replace(at, 20, std::string("direction: ") + direction);
    const scene::Scene scene = good_scene(turned);
    const Vector3d axis = std::get<scene::SnowGun>(scene.emitters[1].what).direction;
    Vector3d mean = Vector3d::Zero();
    for (const Departure& each : departures(scene, 1, 1000)) {
      CHECK(each.velocity.dot(axis) >= 4 * std::cos(10 * std::numbers::pi / 180) - 1e-9);
      CHECK(std::abs((each.position - Vector3d(0.4, 0.5, 0.5)).dot(axis)) < 1e-9);
      mean += each.velocity / 4000;
    }
    CHECK((mean - axis * mean.norm()).norm() < 0.01);
  }
}

TEST_CASE("each emitter brings its own material, in particles of its own number a cell, at random numbers of its own") {
  const scene::Scene scene = good_scene(text);
  const double cell = 0.05 * 0.05 * 0.05;
  CHECK(scene::particle_mass(scene, scene.emitters[0]) == Approx(100 * cell / 8));
  CHECK(scene::particle_mass(scene, scene.emitters[1]) == Approx(300 * cell / 16));
  CHECK(scene::particles_per_second(scene, scene.emitters[1]) == Approx(2 / (300 * cell / 16)));
  const scene::Particles light = scene::emitted(scene, 0, 0, 1, 1), heavy = scene::emitted(scene, 1, 0, 1, 1),
                         other = scene::emitted(scene, 2, 0, 1, 1);
  CHECK(light.volume[0] == Approx(cell / 8));
  CHECK(heavy.volume[0] == Approx(cell / 16));
  CHECK(heavy.mass[0] == Approx(300 * cell / 16));
  CHECK(light.material[0] == scene.emitters[0].material);
  CHECK(heavy.material[0] == scene.emitters[1].material);
  CHECK(light.material[0] != heavy.material[0]);
  CHECK((heavy.position[0] - other.position[0]).norm() > 1e-6);
}

TEST_CASE("the largest speed of an emitter is that with which its particles leave") {
  const scene::Scene scene = good_scene(text);
  CHECK(scene::largest_speed(scene.emitters[0]) == Approx(std::sqrt(1.25)));
  CHECK(scene::largest_speed(scene.emitters[1]) == 4);
}

}  // namespace firn::test
