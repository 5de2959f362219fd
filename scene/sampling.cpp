#include "scene/sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scene/points.h"
#include "scene/read.h"
#include "scene/repeatable.h"
#include "scene/solid.h"

namespace firn::scene {

namespace {

[[noreturn]] void fail(const Place& place, std::string text) {
  config::Diagnostics diagnostics;
  diagnostics.error(place, std::move(text));
  throw config::InputError(std::move(diagnostics));
}

using detail::to_text;

struct CellRange {
  Eigen::Vector3i begin{0, 0, 0}, end{0, 0, 0};  // end is one past the last
};
CellRange cells_touched(const Bounds& bounds, const Domain& domain) {
  const Eigen::Vector3i cells = domain.nodes() - Eigen::Vector3i::Ones();
  CellRange range;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::floor((bounds.min[axis] - domain.min[axis]) / domain.cell);
    const double high = std::floor((bounds.max[axis] - domain.min[axis]) / domain.cell) + 1;
    range.begin[axis] = static_cast<int>(std::clamp<double>(low, 0, cells[axis]));
    range.end[axis] = static_cast<int>(std::clamp<double>(high, 0, cells[axis]));
  }
  return range;
}

// Appends the cells of `range` that may touch the solid. Whole blocks that lie too far from it are left out at once: a thin solid
// that lies askew fills next to nothing of its bounding box.
void add_cells_near(const Inside& inside, const CellRange& range, const Domain& domain, std::vector<Eigen::Vector3i>& cells) {
  const Eigen::Vector3i size = range.end - range.begin;
  if ((size.array() <= 0).any()) return;
  const Vector3d half = 0.5 * domain.cell * size.cast<double>();
  const Vector3d center = domain.min + domain.cell * range.begin.cast<double>() + half;
  const double rounding = 1e-9 * (domain.cell + domain.min.cwiseAbs().maxCoeff() + domain.max.cwiseAbs().maxCoeff());
  if (inside.distance(center) > half.norm() + rounding) return;
  int longest = 0;
  if (size.maxCoeff(&longest) == 1) {
    cells.push_back(range.begin);
    return;
  }
  CellRange low = range, high = range;
  low.end[longest] = high.begin[longest] = range.begin[longest] + size[longest] / 2;
  add_cells_near(inside, low, domain, cells);
  add_cells_near(inside, high, domain, cells);
}

// By z, then y, then x.
std::vector<Eigen::Vector3i> cells_near(const Inside& inside, const CellRange& range, const Domain& domain) {
  std::vector<Eigen::Vector3i> cells;
  add_cells_near(inside, range, domain, cells);
  std::ranges::sort(cells, {}, [](const Eigen::Vector3i& at) { return std::array{at.z(), at.y(), at.x()}; });
  return cells;
}

// The factors of sub_cells() dealt to the axes; one of the six orders, by the cell's own draw.
Eigen::Vector3i dealt(std::array<int, 3> factors, std::uint64_t draw) {
  if (factors[0] != factors[2]) {
    std::swap(factors[0], factors[draw % 3]);
    if ((draw / 3) % 2 == 1) std::swap(factors[1], factors[2]);
  }
  return {factors[0], factors[1], factors[2]};
}

struct Motion {
  Vector3d velocity, spin, center;
  [[nodiscard]] Vector3d at(const Vector3d& point) const { return velocity + repeatable_cross(spin, point - center); }
};

void add(Particles& particles, const Vector3d& position, const Vector3d& velocity, double mass, double volume, int material) {
  particles.position.push_back(position);
  particles.velocity.push_back(velocity);
  particles.mass.push_back(mass);
  particles.volume.push_back(volume);
  particles.material.push_back(material);
}

void fill(const Solid& solid, const Snow& snow, std::uint64_t snow_index, const Scene& scene, Particles& particles) {
  const Domain& domain = *scene.domain;
  const double cell = domain.cell;
  const double volume = cell * cell * cell / snow.per_cell;
  const double mass = scene.materials[static_cast<std::size_t>(snow.material)].density * volume;
  const std::array<int, 3> factors = sub_cells(snow.per_cell);
  const Motion motion{snow.velocity, snow.spin, center_of(solid.shape)};
  const Inside inside(solid);

  for (const Eigen::Vector3i& at : cells_near(inside, cells_touched(bounds_of(solid), domain), domain)) {
    const std::uint64_t draw = hash({scene.seed, snow_index, static_cast<std::uint64_t>(at.x()), static_cast<std::uint64_t>(at.y()),
                                     static_cast<std::uint64_t>(at.z())});
    const Eigen::Vector3i count = dealt(factors, draw);
    for (int sub = 0; sub < snow.per_cell; ++sub) {
      const Eigen::Vector3i index(sub % count.x(), sub / count.x() % count.y(), sub / (count.x() * count.y()));
      Vector3d position;
      for (int axis = 0; axis < 3; ++axis) {
        const double jitter = unit_interval(hash({draw, static_cast<std::uint64_t>(sub), static_cast<std::uint64_t>(axis)}));
        const double in_cells = at[axis] + (index[axis] + jitter) / count[axis];
        position[axis] = std::fma(cell, in_cells, domain.min[axis]);
      }
      if (inside(position)) add(particles, position, motion.at(position), mass, volume, snow.material);
    }
  }
}

// Runs what reads a file of points; what is wrong with the file is told with the place in the scene that names it.
template <typename F>
auto at_place(const Snow& snow, F read) {
  try {
    return read();
  } catch (const std::runtime_error& error) {
    fail(snow.place, error.what());
  }
}

void load(const PointFile& file, const Snow& snow, const Scene& scene, Particles& particles) {
  const Points points = at_place(snow, [&] { return read_points(file.file); });
  const std::size_t count = points.position.size();
  const Domain& domain = *scene.domain;
  const Vector3d low = domain.min + Vector3d::Constant(stencil_margin * domain.cell);
  const Vector3d high = domain.max - Vector3d::Constant(stencil_margin * domain.cell);

  std::size_t outside = 0, first_outside = 0;
  Vector3d mean = Vector3d::Zero();
  for (std::size_t row = 0; row < count; ++row) {
    const Vector3d& position = points.position[row];
    mean += (position - mean) / static_cast<double>(row + 1);
    const bool fits = (position.array() >= low.array()).all() && (position.array() <= high.array()).all();
    if (!fits && outside++ == 0) first_outside = row;
  }
  if (outside > 0)
    fail(snow.place,
         fmt::format("{}: {} of {} points lie outside of the domain less its margin of {} cells, from {} to {}; the first is "
                     "row {}: {}",
                     file.file, outside, count, stencil_margin, to_text(low), to_text(high), first_outside,
                     to_text(points.position[first_outside])));

  const double volume = file.mass / scene.materials[static_cast<std::size_t>(snow.material)].density;
  const Motion motion{snow.velocity, snow.spin, mean};
  for (std::size_t row = 0; row < count; ++row) {
    Vector3d velocity = motion.at(points.position[row]);
    if (!points.velocity.empty()) velocity += points.velocity[row];
    add(particles, points.position[row], velocity, file.mass, volume, snow.material);
  }
}

}  // namespace

std::array<int, 3> sub_cells(int n) {
  std::array<int, 3> best{n, 1, 1};
  for (int c = 1; c * c * c <= n; ++c) {
    if (n % c != 0) continue;
    for (int b = c; b * b <= n / c; ++b) {
      if (n / c % b != 0) continue;
      const std::array<int, 3> candidate{n / c / b, b, c};
      if (candidate[0] * best[2] < best[0] * candidate[2] ||
          (candidate[0] * best[2] == best[0] * candidate[2] && candidate[0] < best[0]))
        best = candidate;
    }
  }
  return best;
}

Particles sample(const Scene& scene) {
  Particles particles;
  for (std::size_t i = 0; i < scene.snow.size(); ++i) {
    const Snow& snow = scene.snow[i];
    if (const std::optional<Solid> solid = solid_of(snow)) {
      fill(*solid, snow, i, scene, particles);
    } else if (const auto* points = std::get_if<PointFile>(&snow.what)) {
      load(*points, snow, scene, particles);
    } else {
      fail(snow.place, "snow from meshes is not supported");
    }
  }
  return particles;
}

double estimate_particles(const Snow& snow, const Domain& domain) {
  const std::optional<Solid> solid = solid_of(snow);
  if (!solid) return 0;
  const double cell = domain.cell;
  // Two bounds, the smaller counts: all sub-cells of the cells that the bounding box touches, and all sub-cells that fit among the
  // points no farther from the shape than a sub-cell is long.
  const Bounds bounds = bounds_of(*solid);
  double in_box = snow.per_cell;
  for (int axis = 0; axis < 3; ++axis)
    in_box *=
        std::floor((bounds.max[axis] - domain.min[axis]) / cell) - std::floor((bounds.min[axis] - domain.min[axis]) / cell) + 1;
  const std::array<int, 3> count = sub_cells(snow.per_cell);
  const double diagonal = cell * Vector3d(1.0 / count[0], 1.0 / count[1], 1.0 / count[2]).norm();
  const double near = grown_volume(*solid, diagonal) / (cell * cell * cell / snow.per_cell);
  return std::min(in_box, std::ceil(near));
}

std::uint64_t estimate_particles(const Scene& scene) {
  double total = 0;
  for (const Snow& snow : scene.snow) {
    if (const auto* points = std::get_if<PointFile>(&snow.what)) {
      total += static_cast<double>(at_place(snow, [&] { return count_points(points->file); }));
    } else if (scene.domain) {
      total += estimate_particles(snow, *scene.domain);
    }
  }
  return total < 0x1p63 ? static_cast<std::uint64_t>(total) : std::uint64_t{1} << 63;
}

}  // namespace firn::scene
