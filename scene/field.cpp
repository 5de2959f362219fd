#include "scene/field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "config/diagnostics.h"
#include "scene/image.h"

namespace firn::scene {

namespace {

std::vector<double> values_of(const FieldSource& source, const Field& field, config::Diagnostics& diagnostics) {
  const std::size_t count = static_cast<std::size_t>(field.cells_x) * static_cast<std::size_t>(field.cells_z);
  if (source.image.empty()) return std::vector<double>(count, source.value);
  try {
    std::vector<double> values =
        resample(read_image(source.image, field.cells_x, field.cells_z), field.cells_x, field.cells_z).values;
    for (double& value : values) value *= source.unit_value;
    return values;
  } catch (const std::runtime_error& error) {
    diagnostics.error(source.place, error.what());
    return {};
  }
}

// The first cell of those that are wrong, and how many they are.
template <typename Wrong>
void report(const std::vector<double>& values, const Field& field, const FieldSource& source, const Wrong& wrong,
            const std::string& what, const std::string& right, config::Diagnostics& diagnostics) {
  std::size_t first = values.size(), count = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!wrong(i)) continue;
    if (count++ == 0) first = i;
  }
  if (count == 0) return;
  const auto columns = static_cast<std::size_t>(field.cells_x);
  diagnostics.error(source.place,
                    fmt::format("{} is {:.6g} in row {}, column {} of the field{}; {}", what, values[first], first / columns,
                                first % columns, count > 1 ? fmt::format(" (one of {} such cells)", count) : "", right));
}

std::vector<float> in_single(const std::vector<double>& values) {
  std::vector<float> result(values.size());
  std::transform(values.begin(), values.end(), result.begin(), [](double value) { return static_cast<float>(value); });
  return result;
}

}  // namespace

FieldArrays sample_field(const Scene& scene) {
  if (!scene.field) throw std::logic_error("sample_field needs a scene with a field");
  const Field& field = *scene.field;
  const Material& material = scene.materials.at(static_cast<std::size_t>(field.material));
  config::Diagnostics diagnostics;
  const std::vector<double> ground = values_of(field.ground, field, diagnostics);
  const std::vector<double> depth = values_of(field.depth, field, diagnostics);
  std::vector<double> density = values_of(field.density, field, diagnostics);

  const auto beyond_single = [](const std::vector<double>& values) {
    return [&values](std::size_t i) { return !(std::abs(values[i]) <= 1e30); };  // the device computes in single precision
  };
  report(ground, field, field.ground, beyond_single(ground), "the field's ground", "it must be a height in metres", diagnostics);
  report(
      depth, field, field.depth, [&](std::size_t i) { return !(depth[i] >= 0) || beyond_single(depth)(i); }, "the field's depth",
      "it must be at least 0 m", diagnostics);
  constexpr double tolerance = 1e-6;  // what resampling may add to a value at the very limit
  report(
      density, field, field.density,
      [&](std::size_t i) {
        if (i < depth.size() && depth[i] == 0) return false;
        return !(density[i] >= material.min_density * (1 - tolerance) && density[i] <= material.max_density * (1 + tolerance));
      },
      "the field's density",
      fmt::format("where snow lies it must be between {:.6g} (min_density) and {:.6g} kg/m3 (max_density of material '{}')",
                  material.min_density, material.max_density, material.name),
      diagnostics);
  config::throw_if_errors(diagnostics);

  for (double& value : density) value = std::clamp(value, material.min_density, material.max_density);
  return {in_single(ground), in_single(depth), in_single(density)};
}

}  // namespace firn::scene
