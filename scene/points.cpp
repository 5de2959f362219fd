#include "scene/points.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "scene/npy.h"

namespace firn::scene {

namespace {

[[noreturn]] void fail(const std::string& file, const std::string& text) {
  throw std::runtime_error(fmt::format("{}: {}", file, text));
}

void check(NpyKind kind, const NpyShape& shape, const std::string& file) {
  if (shape.size() != 2 || (shape[1] != 3 && shape[1] != 6))
    fail(file, fmt::format("points must have the shape (N, 3), or (N, 6) with velocities, not {}", to_string(shape)));
  if (shape[0] == 0) fail(file, "this file holds no points");
  if (kind != NpyKind::float32 && kind != NpyKind::float64)
    fail(file, fmt::format("points must be float32 or float64, not {}", to_string(kind)));
}

}  // namespace

std::uint64_t count_points(const std::string& file) {
  const NpyHeader header = read_npy_header(file);
  check(header.kind, header.shape, file);
  return header.shape[0];
}

Points read_points(const std::string& file) {
  const NpyArray array = read_npy(file);
  check(array.kind, array.shape, file);
  const auto rows = static_cast<std::size_t>(array.shape[0]);
  const auto columns = static_cast<std::size_t>(array.shape[1]);
  for (std::size_t i = 0; i < array.values.size(); ++i)
    if (!std::isfinite(array.values[i]))
      fail(file, fmt::format("row {}, column {} is {}, but must be a finite number", i / columns, i % columns, array.values[i]));

  Points points;
  points.position.reserve(rows);
  if (columns == 6) points.velocity.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const double* values = &array.values[row * columns];
    points.position.emplace_back(values[0], values[1], values[2]);
    if (columns == 6) points.velocity.emplace_back(values[3], values[4], values[5]);
  }
  return points;
}

}  // namespace firn::scene
