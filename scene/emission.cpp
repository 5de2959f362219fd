#include "scene/emission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/repeatable.h"

namespace firn::scene {
namespace {

constexpr double degree = std::numbers::pi / 180;

// As a particle leaves: where, and how fast.
struct Departure {
  Vector3d position, velocity;
};

Departure departure(const Snowfall& snowfall, std::uint64_t random) {
  const double along_x = unit_interval(mix(random + golden_gamma)) - 0.5,
               along_z = unit_interval(mix(random + 2 * golden_gamma)) - 0.5;
  return {snowfall.center + Vector3d(along_x * snowfall.size.x(), 0, along_z * snowfall.size.y()), snowfall.velocity};
}

// Evenly over the nozzle, and evenly over the directions within the spread, both independently.
Departure departure(const SnowGun& gun, std::uint64_t random) {
  const auto number = [&](std::uint64_t i) { return unit_interval(mix(random + i * golden_gamma)); };
  const Quaterniond turn = Quaterniond::FromTwoVectors(Vector3d::UnitY(), gun.direction);
  const double far = gun.radius * std::sqrt(number(1)), place = 2 * std::numbers::pi * number(2);
  const double up = 1 - number(3) * (1 - std::cos(gun.spread * degree)), round = 2 * std::numbers::pi * number(4);
  const double out = std::sqrt(std::max(0.0, 1 - up * up));
  return {gun.position + turn * Vector3d(far * std::cos(place), 0, far * std::sin(place)),
          gun.speed * (turn * Vector3d(out * std::cos(round), up, out * std::sin(round)))};
}

}  // namespace

double particle_mass(const Scene& scene, const Emitter& emitter) {
  return scene.materials[static_cast<std::size_t>(emitter.material)].density * std::pow(scene.domain->cell, 3) / emitter.per_cell;
}

double particles_per_second(const Scene& scene, const Emitter& emitter) {
  const auto* snowfall = std::get_if<Snowfall>(&emitter.what);
  const double rate = snowfall ? snowfall->rate * snowfall->size.prod() : std::get<SnowGun>(emitter.what).rate;  // kg/s
  return rate / particle_mass(scene, emitter);
}

double largest_speed(const Emitter& emitter) {
  const auto* snowfall = std::get_if<Snowfall>(&emitter.what);
  return snowfall ? snowfall->velocity.norm() : std::get<SnowGun>(emitter.what).speed;
}

std::uint64_t emitted_until(const Scene& scene, const Emitter& emitter, double time) {
  const double on = std::min(time, emitter.span.until) - emitter.span.from;
  const double count = std::floor(particles_per_second(scene, emitter) * std::max(0.0, on) + 0.5);
  return static_cast<std::uint64_t>(std::min(count, 4294967295.0));  // counted in 32 bits on the device
}

Particles emitted(const Scene& scene, std::size_t emitter, std::uint64_t first, std::uint64_t last, double time) {
  const Emitter& source = scene.emitters[emitter];
  const double mass = particle_mass(scene, source), rate = particles_per_second(scene, source);
  const double density = scene.materials[static_cast<std::size_t>(source.material)].density;
  Particles particles;
  for (std::uint64_t i = first; i < last; ++i) {
    const std::uint64_t random = hash({scene.seed, emitter, i});
    const auto [position, velocity] = std::visit([&](const auto& what) { return departure(what, random); }, source.what);
    const double age = std::max(0.0, time - source.span.from - (static_cast<double>(i) + 0.5) / rate);
    particles.position.push_back(position + age * (velocity + 0.5 * age * scene.gravity));
    particles.velocity.push_back(velocity + age * scene.gravity);
    particles.mass.push_back(mass);
    particles.volume.push_back(mass / density);
    particles.material.push_back(source.material);
  }
  return particles;
}

void check_room(const Scene& scene, std::size_t particles, config::Diagnostics& diagnostics) {
  if (scene.max_particles == 0) return;
  if (particles > scene.max_particles) {
    diagnostics.error(
        scene.max_particles_place,
        fmt::format("the scene begins with {} particles, more than max_particles: {}; what comes needs room beside them", particles,
                    scene.max_particles));
    return;
  }
  std::uint64_t most = particles;
  for (const Emitter& emitter : scene.emitters) most += emitted_until(scene, emitter, scene.time.end);
  if (most > scene.max_particles && scene.sinks.empty())
    diagnostics.warning(scene.max_particles_place,
                        fmt::format("until {:g} s there would be {} particles, but there is room for {}: emitters will stop early; "
                                    "max_particles: {} is enough",
                                    scene.time.end, most, scene.max_particles, most));
}

}  // namespace firn::scene
