#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/emission.h"
#include "scene/read.h"
#include "scene/solid.h"

namespace firn::scene::detail {

namespace {

constexpr double degree = std::numbers::pi / 180;

std::optional<Snowfall> read_snowfall(const Node& node, Diagnostics& diagnostics) {
  Reader reader(node, "a snowfall", diagnostics);
  Snowfall snowfall;
  const std::optional<Vector3d> center = required_vector3(reader, "center");
  std::optional<std::vector<double>> size;
  if (const Node* extent = reader.require("size")) size = read_numbers(*extent, "size (along x and z)", 2, positive, diagnostics);
  snowfall.rate = reader.required_number("rate", not_negative);
  snowfall.velocity = vector3(reader, "velocity", snowfall.velocity);
  reader.finish();
  if (!center || !size || std::isnan(snowfall.rate)) return std::nullopt;
  snowfall.center = *center;
  snowfall.size = {(*size)[0], (*size)[1]};
  return snowfall;
}

std::optional<SnowGun> read_gun(const Node& node, Diagnostics& diagnostics) {
  Reader reader(node, "a snow gun", diagnostics);
  SnowGun gun;
  const std::optional<Vector3d> position = required_vector3(reader, "position"), direction = required_vector3(reader, "direction");
  gun.speed = reader.required_number("speed", positive);
  gun.spread = reader.number("spread", gun.spread, {0, 90, false, false});
  gun.radius = reader.required_number("radius", positive);
  gun.rate = reader.required_number("rate", not_negative);
  reader.finish();
  if (direction && !(direction->norm() > 0)) {
    diagnostics.error(node.find("direction")->place, "the direction of a snow gun must not be zero; [0, 1, 0] points up");
    return std::nullopt;
  }
  if (!position || !direction || std::isnan(gun.speed) || std::isnan(gun.radius) || std::isnan(gun.rate)) return std::nullopt;
  gun.position = *position;
  gun.direction = direction->normalized();
  return gun;
}

Span read_span(Reader& reader) {
  Span span;
  span.from = reader.number("from", span.from, not_negative);
  if (const Node* until = reader.find("until")) {
    span.until = reader.number("until", span.until, not_negative);
    if (span.until <= span.from)
      reader.diagnostics().error(
          until->place, fmt::format("until must be later than from: {:g} s is not later than {:g} s", span.until, span.from));
  }
  return span;
}

// Everywhere that particles can be when they are placed: they have left the emitter at most a frame ago.
struct Reach {
  Vector3d low, high;

  void fly(const Vector3d& slowest, const Vector3d& fastest, const Vector3d& gravity, double time) {
    for (int axis = 0; axis < 3; ++axis) {
      const double fall = 0.5 * gravity[axis] * time * time;
      low[axis] += std::min(0.0, slowest[axis] * time) + std::min(0.0, fall);
      high[axis] += std::max(0.0, fastest[axis] * time) + std::max(0.0, fall);
    }
  }
};

Reach reach_of(const Snowfall& snowfall, const Vector3d& gravity, double time) {
  const Vector3d half(0.5 * snowfall.size.x(), 0, 0.5 * snowfall.size.y());
  Reach reach{snowfall.center - half, snowfall.center + half};
  reach.fly(snowfall.velocity, snowfall.velocity, gravity, time);
  return reach;
}

Reach reach_of(const SnowGun& gun, const Vector3d& gravity, double time) {
  Vector3d half, slowest, fastest;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = std::clamp(gun.direction[axis], -1.0, 1.0), angle = std::acos(along);
    half[axis] = gun.radius * std::sqrt(1 - along * along);
    fastest[axis] = gun.speed * std::cos(std::max(0.0, angle - gun.spread * degree));
    slowest[axis] = gun.speed * std::cos(std::min(std::numbers::pi, angle + gun.spread * degree));
  }
  Reach reach{gun.position - half, gun.position + half};
  reach.fly(slowest, fastest, gravity, time);
  return reach;
}

void check_reach(const Emitter& emitter, const Reach& reach, const Domain& domain, Diagnostics& diagnostics) {
  const double margin = stencil_margin * domain.cell, tolerance = 1e-6 * domain.cell;
  const Vector3d low = domain.min + Vector3d::Constant(margin), high = domain.max - Vector3d::Constant(margin);
  for (int axis = 0; axis < 3; ++axis)
    if (reach.low[axis] < low[axis] - tolerance || reach.high[axis] > high[axis] + tolerance)
      diagnostics.error(emitter.place,
                        fmt::format("within a frame particles of this emitter reach {} {:.4g} to {:.4g}, but snow must stay at "
                                    "{:.6g} to {:.6g}, {} cells from the domain's faces",
                                    "xyz"[axis], reach.low[axis], reach.high[axis], low[axis], high[axis], stencil_margin));
}

// kg/m3 of what leaves it: rate over the speed at which it leaves.
double density_of(const Snowfall& snowfall) { return snowfall.rate / std::abs(snowfall.velocity.y()); }
double density_of(const SnowGun& gun) { return gun.rate / (std::numbers::pi * gun.radius * gun.radius * gun.speed); }

}  // namespace

std::optional<Emitter> read_emitter(const Node& node, std::vector<Material>& materials, Diagnostics& diagnostics) {
  Reader reader(node, "an emitter", diagnostics);
  Emitter emitter;
  emitter.place = node.place;
  bool complete = false;
  const auto take = [&](const auto& what) {
    complete = what.has_value();
    if (complete) emitter.what = *what;
  };
  const std::optional<Kind> kind = one_of(reader, {"snowfall", "gun"}, "an emitter");
  if (kind && kind->name == "snowfall") take(read_snowfall(*kind->node, diagnostics));
  if (kind && kind->name == "gun") take(read_gun(*kind->node, diagnostics));
  const std::optional<int> material = required_material(reader, "material", materials);
  emitter.per_cell = static_cast<int>(reader.integer("per_cell", emitter.per_cell, {1, 64}));
  emitter.span = read_span(reader);
  reader.finish();
  if (!complete || !material) return std::nullopt;
  emitter.material = *material;
  return emitter;
}

std::optional<Sink> read_sink(const Node& node, Diagnostics& diagnostics) {
  Reader reader(node, "a sink", diagnostics);
  const Node* box = reader.require("box");
  const std::optional<Box> read = box ? read_box(*box, true, diagnostics) : std::nullopt;
  const Span span = read_span(reader);
  reader.finish();
  if (!read) return std::nullopt;
  return Sink{*read, span, node.place};
}

void check_emitters(const Scene& scene, Diagnostics& diagnostics) {
  const Domain& domain = *scene.domain;
  for (const Emitter& emitter : scene.emitters) {
    std::visit(
        [&](const auto& what) { check_reach(emitter, reach_of(what, scene.gravity, 1 / scene.time.fps), domain, diagnostics); },
        emitter.what);
    const Material& material = scene.materials[static_cast<std::size_t>(emitter.material)];
    if (const double density = std::visit([](const auto& what) { return density_of(what); }, emitter.what);
        density > material.density)
      diagnostics.warning(emitter.place,
                          fmt::format("what leaves this emitter is denser, {:.3g} kg/m3, than its material, {:.3g} kg/m3; "
                                      "it needs a smaller rate, or more room or speed",
                                      density, material.density));
  }
  if (!scene.emitters.empty() && scene.max_particles_place.file.empty())
    diagnostics.error(scene.emitters.front().place,
                      "emitters need to be told how many particles there may be at once: max_particles: N, beside 'emitters'");
  for (const Sink& sink : scene.sinks)
    for (int axis = 0; axis < 3; ++axis) {
      const double low = sink.box.center[axis] - sink.box.half_size[axis], high = sink.box.center[axis] + sink.box.half_size[axis];
      if (low <= domain.max[axis] && high >= domain.min[axis]) continue;
      diagnostics.error(sink.place,
                        fmt::format("this sink lies outside the domain: at {} {:.6g} to {:.6g}, the domain at {:.6g} to {:.6g}",
                                    "xyz"[axis], low, high, domain.min[axis], domain.max[axis]));
      break;
    }
}

}  // namespace firn::scene::detail
