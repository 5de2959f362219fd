#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/mesh_solid.h"
#include "scene/read.h"
#include "scene/sampling.h"
#include "scene/solid.h"

namespace firn::scene::detail {

namespace {

// Position 3, velocity 3, elastic deformation 9, plastic volume, volume, mass (part M of the model): 18 floats.
constexpr double bytes_per_particle = 72;

void check_inside(const Snow& snow, const Bounds& bounds, const char* name, const Domain& domain, Diagnostics& diagnostics) {
  const double margin = stencil_margin * domain.cell, tolerance = 1e-6 * domain.cell;
  const auto report = [&](int axis, const char* side, double excess, double reached, const char* order, double limit) {
    diagnostics.error(
        snow.place,
        fmt::format("the {} sticks out of the domain by {:.6g} m on the {} {} side: it reaches {:.6g}, but snow must stay at "
                    "{} {} {:.6g}, {} cells from the domain's face",
                    name, excess, side, "xyz"[axis], reached, "xyz"[axis], order, limit, stencil_margin));
  };
  for (int axis = 0; axis < 3; ++axis) {
    const double low = domain.min[axis] + margin, high = domain.max[axis] - margin;
    if (bounds.min[axis] < low - tolerance) report(axis, "low", low - bounds.min[axis], bounds.min[axis], ">=", low);
    if (bounds.max[axis] > high + tolerance) report(axis, "high", bounds.max[axis] - high, bounds.max[axis], "<=", high);
  }
}

// Bounds of everywhere that the body's own motion takes it between 0 and the end.
std::optional<Bounds> swept_bounds(const Body& body, const Time& time, const Vector3d& gravity) {
  std::optional<Bounds> swept;
  const auto include = [&](const Vector3d& position, const Quaterniond& turn) {
    const std::optional<Solid> solid = solid_of(body, position, turn);
    if (!solid) return;
    const Bounds bounds = bounds_of(*solid);
    if (!swept) swept = bounds;
    swept->min = swept->min.cwiseMin(bounds.min);
    swept->max = swept->max.cwiseMax(bounds.max);
  };
  if (!body.path.empty()) {
    for (const KeyFrame& key : body.path) include(key.position, key.orientation);
    return swept;
  }
  const Vector3d acceleration = body.mass ? gravity : Vector3d::Zero();
  const auto at = [&](double t) -> Vector3d { return body.position + t * body.velocity + 0.5 * t * t * acceleration; };
  include(body.position, body.orientation);
  include(at(time.end), body.orientation);
  for (int axis = 0; axis < 3; ++axis) {  // the turning points of a throw
    const double turn = -body.velocity[axis] / acceleration[axis];
    if (turn > 0 && turn < time.end) include(at(turn), body.orientation);
  }
  return swept;
}

}  // namespace

void check_snow(const std::vector<Snow>& snow, const Domain& domain, Diagnostics& diagnostics) {
  double particles = 0;
  for (const Snow& each : snow) {
    if (const std::optional<Solid> solid = solid_of(each))
      check_inside(each, bounds_of(*solid), name_of(solid->shape), domain, diagnostics);
    else if (const auto* mesh = std::get_if<SolidMesh>(&each.what))
      check_inside(each, mesh->solid->bounds(), "mesh", domain, diagnostics);
    else
      continue;
    const double more = estimate_particles(each, domain);
    if (particles <= most_particles && particles + more > most_particles)
      diagnostics.error(
          each.place,
          fmt::format("with this snow there are about {:.4g} particles, which is beyond 2^31 and would take {:.0f} GiB; a larger "
                      "cell or a smaller per_cell is needed",
                      particles + more, (particles + more) * bytes_per_particle / (1 << 30)));
    particles += more;
  }
}

void check_bodies(const std::vector<Body>& bodies, const Domain& domain, const Time& time, const Vector3d& gravity,
                  Diagnostics& diagnostics) {
  for (const Body& body : bodies) {
    const std::optional<Bounds> swept = swept_bounds(body, time, gravity);
    if (!swept) continue;
    for (int axis = 0; axis < 3; ++axis) {
      if (swept->max[axis] >= domain.min[axis] && swept->min[axis] <= domain.max[axis]) continue;
      diagnostics.error(body.place,
                        fmt::format("body outside the domain: '{}' lies at {} {:.6g} to {:.6g}{}, the domain at {:.6g} to {:.6g}",
                                    body.name, "xyz"[axis], swept -> min[axis], swept -> max[axis],
                                    body.path.empty() && body.velocity.isZero() && !body.mass ? "" : " all the time",
                                    domain.min[axis], domain.max[axis]));
      break;
    }
  }
}

}  // namespace firn::scene::detail
