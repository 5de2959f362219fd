// Particles that come while time passes: how many, where, and what is refused.

#include "scene/emission.h"

#include <algorithm>
#include <numbers>

#include "tests/scene/support.h"

namespace firn::test {

namespace {

// 1 kg of `light` fills 0.01 m3, a particle weighs 100 * 0.05^3 / 8 = 1.5625e-3 kg: the snowfall brings 640 a second, the gun 1280.
const std::string base = R"(firn: 1
name: base
seed: 3
time: {dt: 1.0e-3, fps: 50, end: 2.0}
gravity: [0, -10, 0]
domain: {min: [0, 0, 0], max: [2, 1.5, 1], cell: 0.05}
materials:
  light: {preset: new_snow, density: 100}
emitters:
  - {snowfall: {center: [1, 1, 0.5], size: [1, 0.5], rate: 2, velocity: [0.5, -1, 0]}, material: light, from: 0.25, until: 1.5}
  - {gun: {position: [0.4, 0.5, 0.5], direction: [3, 0, 0], speed: 4, spread: 10, radius: 0.1, rate: 2}, material: light}
sinks:
  - {box: {min: [0, 0, 0], max: [2, 0.3, 1]}, from: 1}
max_particles: 5000
)";
const std::string snowfall = "{snowfall: {center: [1, 1, 0.5], size: [1, 0.5], rate: 2, velocity: [0.5, -1, 0]}";

std::string changed(const std::string& from, const std::string& to) {
  std::string text = base;
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

// That this is said of the changed scene, at this place of it; and, but for `others`, nothing else.
void check_told(const std::string& from, const std::string& to, const std::string& at, const std::string& fragment,
                config::Severity severity = config::Severity::error, std::size_t others = 0) {
  const std::string text = changed(from, to);
  const ReadResult result = read_text(text);
  INFO(result.text());
  REQUIRE(result.diagnostics.all().size() == 1 + others);
  const auto found = std::ranges::find_if(
      result.diagnostics.all(), [&](const config::Diagnostic& one) { return one.text.find(fragment) != std::string::npos; });
  INFO("expected: " << fragment);
  REQUIRE(found != result.diagnostics.all().end());
  const config::Diagnostic& told = *found;
  CHECK(told.severity == severity);
  const std::array<int, 2> place = place_of(text, at);
  CHECK(told.place.line == place[0]);
  CHECK(told.place.column == place[1]);
}

}  // namespace

TEST_CASE("emitters, sinks and the declared maximum are read") {
  const scene::Scene scene = good_scene(base);
  REQUIRE(scene.emitters.size() == 2);
  const auto& fall = std::get<scene::Snowfall>(scene.emitters[0].what);
  CHECK(fall.center == Eigen::Vector3d(1, 1, 0.5));
  CHECK(fall.size == Eigen::Vector2d(1, 0.5));
  CHECK(fall.rate == 2);
  CHECK(fall.velocity == Eigen::Vector3d(0.5, -1, 0));
  CHECK(scene.emitters[0].span.from == 0.25);
  CHECK(scene.emitters[0].span.until == 1.5);
  const auto& gun = std::get<scene::SnowGun>(scene.emitters[1].what);
  CHECK(gun.direction == Eigen::Vector3d(1, 0, 0));
  CHECK(gun.speed == 4);
  CHECK(scene.emitters[1].span.until > 1e300);
  REQUIRE(scene.sinks.size() == 1);
  CHECK(scene.sinks[0].box.half_size == Eigen::Vector3d(1, 0.15, 0.5));
  CHECK(scene.sinks[0].span.from == 1);
  CHECK(scene.max_particles == 5000);
  CHECK(scene.has_particles());
}

TEST_CASE("at every moment an emitter is within half a particle of its rate, and stands still outside its time") {
  const scene::Scene scene = good_scene(base);
  CHECK(scene::particle_mass(scene, scene.emitters[0]) == Approx(1.5625e-3));
  CHECK(scene::particles_per_second(scene, scene.emitters[0]) == Approx(640));
  CHECK(scene::particles_per_second(scene, scene.emitters[1]) == Approx(1280));
  for (double time = 0; time < 2.5; time += 0.0137) {
    CAPTURE(time);
    const double on = std::clamp(time - 0.25, 0.0, 1.25);
    CHECK(std::abs(static_cast<double>(scene::emitted_until(scene, scene.emitters[0], time)) - 640 * on) <= 0.5 + 1e-9);
    CHECK(std::abs(static_cast<double>(scene::emitted_until(scene, scene.emitters[1], time)) - 1280 * time) <= 0.5 + 1e-9);
  }
  CHECK(scene::emitted_until(scene, scene.emitters[0], 0.25) == 0);
  CHECK(scene::emitted_until(scene, scene.emitters[0], 9) == scene::emitted_until(scene, scene.emitters[0], 1.5));
  CHECK(scene::emitted_until(scene, scene.emitters[1], 1e9) == 4294967295u);
}

TEST_CASE("particles have left their emitter in its area, its directions and at even intervals, and have flown freely since") {
  const scene::Scene scene = good_scene(base);
  const double time = 0.5;
  const scene::Particles fallen = scene::emitted(scene, 0, 0, 160, time);
  REQUIRE(fallen.position.size() == 160);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 160; ++i) {
    const double age = time - 0.25 - (static_cast<double>(i) + 0.5) / 640;
    const Eigen::Vector3d left = fallen.position[i] - age * Eigen::Vector3d(0.5, -1, 0) - 0.5 * age * age * scene.gravity;
    CHECK(left.y() == Approx(1));
    CHECK(std::abs(left.x() - 1) <= 0.5 + 1e-12);
    CHECK(std::abs(left.z() - 0.5) <= 0.25 + 1e-12);
    CHECK((fallen.velocity[i] - Eigen::Vector3d(0.5, -1 - 10 * age, 0)).norm() < 1e-12);
    mean += left / 160;
  }
  CHECK(std::abs(mean.x() - 1) < 4 * 0.29 / std::sqrt(160.0));
  CHECK(std::abs(mean.z() - 0.5) < 4 * 0.145 / std::sqrt(160.0));

  const scene::Particles shot = scene::emitted(scene, 1, 100, 400, time);
  double widest = 0, farthest = 0;
  for (std::size_t i = 0; i < shot.position.size(); ++i) {
    const double age = time - (static_cast<double>(i + 100) + 0.5) / 1280;
    const Eigen::Vector3d speed = shot.velocity[i] - age * scene.gravity;
    CHECK(speed.norm() == Approx(4));
    const double angle = std::acos(speed.x() / 4) * 180 / std::numbers::pi;
    CHECK(angle <= 10 + 1e-6);
    widest = std::max(widest, angle);
    const Eigen::Vector3d left = shot.position[i] - age * speed - 0.5 * age * age * scene.gravity - Eigen::Vector3d(0.4, 0.5, 0.5);
    CHECK(std::abs(left.x()) < 1e-9);
    CHECK(left.norm() <= 0.1 + 1e-9);
    farthest = std::max(farthest, left.norm());
    CHECK(shot.volume[i] == Approx(0.05 * 0.05 * 0.05 / 8));
    CHECK(shot.material[i] == scene.emitters[1].material);
  }
  CHECK(widest > 9);
  CHECK(farthest > 0.095);
}

TEST_CASE("it does not matter to what is emitted in how many portions it comes, but the seed does") {
  scene::Scene scene = good_scene(base);
  const scene::Particles whole = scene::emitted(scene, 1, 0, 50, 0.1);
  const scene::Particles late = scene::emitted(scene, 1, 20, 50, 0.1);
  for (std::size_t i = 20; i < 50; ++i) CHECK(whole.position[i] == late.position[i - 20]);
  scene.seed = 4;
  CHECK(scene::emitted(scene, 1, 0, 1, 0.1).position[0] != whole.position[0]);
}

TEST_CASE("what is wrong with emitters and sinks is told at its place") {
  check_told("max_particles: 5000\n", "", snowfall, "max_particles: N");
  check_told("max_particles: 5000", "max_particles: 0", "0\n", "max_particles");
  check_told("rate: 2, velocity", "rat: 2, velocity", "rat:", "did you mean 'rate'", config::Severity::error,
             1);  // and 'rate' is missing
  check_told("rate: 2, velocity", "rate: -2, velocity", "-2, velocity", "rate");
  check_told("until: 1.5", "until: 0.2", "0.2}", "until must be later than from: 0.2 s is not later than 0.25 s");
  check_told("until: 1.5", "until: 0.25", "0.25}", "until must be later than from: 0.25 s is not later than 0.25 s");
  check_told("size: [1, 0.5]", "size: [1, 0.5, 1]", "[1, 0.5, 1]", "must be a list of 2 numbers");
  check_told("direction: [3, 0, 0]", "direction: [0, 0, 0]", "[0, 0, 0], speed", "must not be zero");
  check_told("spread: 10", "spread: 91", "91", "spread");
  check_told("{snowfall: {center", "{snow: {center", "{snow: {center", "an emitter needs one of snowfall, gun",
             config::Severity::error, 1);
  check_told("material: light, from", "material: lihgt, from", "lihgt", "light");
  check_told("center: [1, 1, 0.5]", "center: [1, 1.45, 0.5]", "{snowfall: {center: [1, 1.45",
             "within a frame particles of this emitter reach y 1.428 to 1.45");
  check_told("center: [1, 1, 0.5]", "center: [1, 1, 0.34]", "{snowfall: {center: [1, 1, 0.34", "reach z 0.09 to 0.59");
  check_told("position: [0.4, 0.5, 0.5]", "position: [0.4, 0.5, 0.205]", "{gun", "reach z 0.09111 to 0.3189");
  check_told("position: [0.4, 0.5, 0.5]", "position: [1.85, 0.5, 0.5]", "{gun", "reach x");
  check_told("max: [2, 0.3, 1]}", "max: [2, 0.3, -1]}", "[2, 0.3, -1]", "greater than its min along z");
  check_told("min: [0, 0, 0], max: [2, 0.3, 1]", "min: [0, 2, 0], max: [2, 2.3, 1]", "{box: {min: [0, 2", "outside the domain");
  check_told("min: [0, 0, 0], max: [2, 0.3, 1]", "min: [0, -2, 0], max: [2, -1, 1]", "{box: {min: [0, -2", "outside the domain");
  check_told("rate: 2, velocity", "rate: 110, velocity", "{snowfall", "denser, 110 kg/m3, than its material, 100 kg/m3",
             config::Severity::warning);
  check_told("radius: 0.1, rate: 2", "radius: 0.1, rate: 20", "{gun", "denser, 159 kg/m3, than its material, 100 kg/m3",
             config::Severity::warning);
}

TEST_CASE("a scene that begins with nothing but emitters is a scene, and needs a domain") {
  CHECK(scene::sample(good_scene(base)).position.empty());
  std::string text = changed("domain: {min: [0, 0, 0], max: [2, 1.5, 1], cell: 0.05}\n", "");
  const ReadResult result = read_text(text);
  REQUIRE(result.diagnostics.all().size() == 1);
  CHECK(result.diagnostics.all()[0].text.find("snow needs a domain") != std::string::npos);
  CHECK(result.diagnostics.all()[0].place.line == place_of(text, snowfall)[0]);
}

TEST_CASE("a maximum that does not suffice is an error where the scene begins with more, and a warning where more will come") {
  const scene::Scene scene = good_scene(changed("sinks:\n  - {box: {min: [0, 0, 0], max: [2, 0.3, 1]}, from: 1}\n", ""));
  config::Diagnostics enough, many, more;
  scene::check_room(scene, 5000 - 800 - 2560, enough);
  CHECK(enough.all().empty());
  scene::check_room(scene, 5001, many);
  REQUIRE(many.all().size() == 1);
  CHECK(many.has_errors());
  CHECK(many.all()[0].text.find("begins with 5001 particles, more than max_particles: 5000") != std::string::npos);
  scene::check_room(scene, 5000 - 800 - 2560 + 1, more);
  REQUIRE(more.all().size() == 1);
  CHECK_FALSE(more.has_errors());
  CHECK(more.all()[0].text.find("max_particles: 5001 is enough") != std::string::npos);
  config::Diagnostics as_many;
  scene::check_room(scene, 5000, as_many);
  CHECK_FALSE(as_many.has_errors());
  config::Diagnostics with_sink;
  scene::check_room(good_scene(base), 4999, with_sink);
  CHECK(with_sink.all().empty());
}

}  // namespace firn::test
