#include "scene/sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>

#include "scene/mesh_solid.h"
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

// A shape to be filled: a solid or a mesh.
struct Filling {
  Bounds bounds;
  Vector3d center;
  std::function<bool(const Vector3d&)> inside;
  // Whether all of a ball is inside or none of it, where that can be told at once.
  std::function<std::optional<bool>(const Vector3d& center, double radius)> whole;
};

Filling filling(const Solid& solid) {
  const Inside inside(solid);
  return {bounds_of(solid), center_of(solid.shape), inside, [inside](const Vector3d& center, double radius) {
            return inside.distance(center) > radius ? std::optional(false) : std::nullopt;
          }};
}

Filling filling(const MeshSolid& mesh) {
  return {mesh.bounds(), mass_properties(mesh.mesh()).center, [&](const Vector3d& point) { return mesh.inside(point); },
          [&](const Vector3d& center, double radius) { return mesh.inside(center, radius); }};
}

// Whether all of a cell is inside, none, or each point has to be asked.
std::optional<bool> whole_cell(const Filling& shape, const Eigen::Vector3i& at, const Domain& domain) {
  const Vector3d center = domain.min + domain.cell * (at.cast<double>() + Vector3d::Constant(0.5));
  return shape.whole(center, 0.5 * std::sqrt(3.0) * domain.cell);
}

// Appends the cells of `range` that may touch the shape. Whole blocks that lie too far from it are left out at once: a thin one
// that lies askew fills next to nothing of its bounding box.
void add_cells_near(const Filling& shape, const CellRange& range, const Domain& domain, std::vector<Eigen::Vector3i>& cells) {
  const Eigen::Vector3i size = range.end - range.begin;
  if ((size.array() <= 0).any()) return;
  const Vector3d half = 0.5 * domain.cell * size.cast<double>();
  const Vector3d center = domain.min + domain.cell * range.begin.cast<double>() + half;
  const double rounding = 1e-9 * (domain.cell + domain.min.cwiseAbs().maxCoeff() + domain.max.cwiseAbs().maxCoeff());
  if (shape.whole(center, half.norm() + rounding) == false) return;
  int longest = 0;
  if (size.maxCoeff(&longest) == 1) {
    cells.push_back(range.begin);
    return;
  }
  CellRange low = range, high = range;
  low.end[longest] = high.begin[longest] = range.begin[longest] + size[longest] / 2;
  add_cells_near(shape, low, domain, cells);
  add_cells_near(shape, high, domain, cells);
}

// By z, then y, then x.
std::vector<Eigen::Vector3i> cells_near(const Filling& shape, const CellRange& range, const Domain& domain) {
  std::vector<Eigen::Vector3i> cells;
  add_cells_near(shape, range, domain, cells);
  std::ranges::sort(cells, {}, [](const Eigen::Vector3i& at) { return std::array{at.z(), at.y(), at.x()}; });
  return cells;
}

void fill(const Filling& shape, const Snow& snow, std::uint64_t snow_index, const Scene& scene, Particles& particles) {
  const Domain& domain = *scene.domain;
  const double cell = domain.cell;
  const double volume = cell * cell * cell / snow.per_cell;
  const double mass = scene.materials[static_cast<std::size_t>(snow.material)].density * volume;
  const std::array<int, 3> factors = sub_cells(snow.per_cell);
  const Motion motion{snow.velocity, snow.spin, shape.center};

  for (const Eigen::Vector3i& at : cells_near(shape, cells_touched(shape.bounds, domain), domain)) {
    const std::uint64_t draw = hash({scene.seed, snow_index, static_cast<std::uint64_t>(at.x()), static_cast<std::uint64_t>(at.y()),
                                     static_cast<std::uint64_t>(at.z())});
    const Eigen::Vector3i count = dealt(factors, draw);
    const std::optional<bool> whole = whole_cell(shape, at, domain);
    if (whole == false) continue;
    for (int sub = 0; sub < snow.per_cell; ++sub) {
      const Eigen::Vector3i index(sub % count.x(), sub / count.x() % count.y(), sub / (count.x() * count.y()));
      Vector3d position;
      for (int axis = 0; axis < 3; ++axis) {
        const double jitter = unit_interval(hash({draw, static_cast<std::uint64_t>(sub), static_cast<std::uint64_t>(axis)}));
        const double in_cells = at[axis] + (index[axis] + jitter) / count[axis];
        position[axis] = std::fma(cell, in_cells, domain.min[axis]);
      }
      if (whole || shape.inside(position)) add(particles, position, motion.at(position), mass, volume, snow.material);
    }
  }
}

// Random places no two of which are nearer than a distance, as many as find room (random sequential addition, in rounds of
// `per_cell` darts a cell). The distance is such that about per_cell stay in a cell.
void scatter(const Filling& shape, const Snow& snow, std::uint64_t snow_index, const Scene& scene, Particles& particles) {
  constexpr std::uint64_t rounds = 24;
  constexpr double crowding = 0.58;  // places per cube of the distance after so many rounds, measured
  const Domain& domain = *scene.domain;
  const double cell = domain.cell, distance = cell * std::cbrt(crowding / snow.per_cell);
  const CellRange range = cells_touched(shape.bounds, domain);
  const Eigen::Vector3i extent = range.end - range.begin;
  if ((extent.array() <= 0).any()) return;
  std::vector<std::vector<Vector3d>> places(static_cast<std::size_t>(extent.prod()));
  const auto index = [&](int x, int y, int z) {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(extent.y()) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(extent.x()) +
           static_cast<std::size_t>(x);
  };
  const auto has_room = [&](const Vector3d& place, const Eigen::Vector3i& at) {
    const Eigen::Vector3i low = (at - Eigen::Vector3i::Ones()).cwiseMax(0),
                          high = (at + Eigen::Vector3i::Ones()).cwiseMin(extent - Eigen::Vector3i::Ones());
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x)
          for (const Vector3d& other : places[index(x, y, z)])
            if ((other - place).squaredNorm() < distance * distance) return false;
    return true;
  };
  std::vector<std::optional<bool>> whole(places.size());
  std::uint64_t darts = 0, hits = 0;
  for (std::uint64_t round = 0; round < rounds; ++round) {
    Eigen::Vector3i at;
    for (at.z() = 0; at.z() < extent.z(); ++at.z())
      for (at.y() = 0; at.y() < extent.y(); ++at.y())
        for (at.x() = 0; at.x() < extent.x(); ++at.x()) {
          const std::size_t here = index(at.x(), at.y(), at.z());
          if (round == 0) whole[here] = whole_cell(shape, at + range.begin, domain);
          darts += static_cast<std::uint64_t>(snow.per_cell);
          if (whole[here] == false) continue;
          const std::uint64_t draw = hash({scene.seed, snow_index, here, round});
          for (int dart = 0; dart < snow.per_cell; ++dart) {
            Vector3d place;
            for (int axis = 0; axis < 3; ++axis)
              place[axis] =
                  std::fma(cell,
                           range.begin[axis] + at[axis] +
                               unit_interval(hash({draw, static_cast<std::uint64_t>(dart), static_cast<std::uint64_t>(axis)})),
                           domain.min[axis]);
            if (!whole[here] && !shape.inside(place)) continue;
            ++hits;
            if (has_room(place, at)) places[here].push_back(place);
          }
        }
  }
  std::size_t count = 0;
  for (const std::vector<Vector3d>& in_cell : places) count += in_cell.size();
  if (count == 0) return;
  // The share of darts that hit the shape is its share of the cells; the particles divide its volume among them.
  const double volume = static_cast<double>(hits) / static_cast<double>(darts) * static_cast<double>(places.size()) * cell * cell *
                        cell / static_cast<double>(count);
  const double mass = scene.materials[static_cast<std::size_t>(snow.material)].density * volume;
  const Motion motion{snow.velocity, snow.spin, shape.center};
  for (const std::vector<Vector3d>& in_cell : places)
    for (const Vector3d& place : in_cell) add(particles, place, motion.at(place), mass, volume, snow.material);
}

void fill_shape(const Filling& shape, const Snow& snow, std::uint64_t snow_index, const Scene& scene, Particles& particles) {
  (snow.sampling == Sampling::poisson ? scatter : fill)(shape, snow, snow_index, scene, particles);
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
      fill_shape(filling(*solid), snow, i, scene, particles);
    } else if (const auto* mesh = std::get_if<SolidMesh>(&snow.what)) {
      fill_shape(filling(*mesh->solid), snow, i, scene, particles);
    } else if (const auto* points = std::get_if<PointFile>(&snow.what)) {
      load(*points, snow, scene, particles);
    }
  }
  return particles;
}

double estimate_particles(const Snow& snow, const Domain& domain) {
  const std::optional<Solid> solid = solid_of(snow);
  const auto* mesh = std::get_if<SolidMesh>(&snow.what);
  if (!solid && mesh == nullptr) return 0;
  const double cell = domain.cell;
  // Two bounds, the smaller counts: all sub-cells of the cells that the bounding box touches, and all sub-cells that fit among the
  // points no farther from the shape than a sub-cell is long.
  const Bounds bounds = solid ? bounds_of(*solid) : mesh->solid->bounds();
  // Particles that keep a distance crowd somewhat at a surface: beyond it there is none to keep it from.
  const double per_cell = snow.sampling == Sampling::poisson ? 1.5 * snow.per_cell : snow.per_cell;
  double in_box = per_cell;
  for (int axis = 0; axis < 3; ++axis)
    in_box *=
        std::floor((bounds.max[axis] - domain.min[axis]) / cell) - std::floor((bounds.min[axis] - domain.min[axis]) / cell) + 1;
  const std::array<int, 3> count = sub_cells(snow.per_cell);
  const double diagonal = cell * Vector3d(1.0 / count[0], 1.0 / count[1], 1.0 / count[2]).norm();
  if (mesh != nullptr) return in_box;
  const double near = grown_volume(*solid, diagonal) / (cell * cell * cell / per_cell);
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
