#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <system_error>

#include "config/links.h"
#include "config/nearest.h"
#include "scene/read.h"

namespace firn::scene::detail {

Vector3d vector3(Reader& reader, std::string_view key, const Vector3d& fallback, const Range& range) {
  const config::Vector3 value = reader.vector3(key, {fallback.x(), fallback.y(), fallback.z()}, range);
  return {value[0], value[1], value[2]};
}

std::optional<Vector3d> required_vector3(Reader& reader, std::string_view key, const Range& range) {
  const std::optional<config::Vector3> value = reader.required_vector3(key, range);
  if (!value) return std::nullopt;
  return Vector3d((*value)[0], (*value)[1], (*value)[2]);
}

std::optional<std::vector<double>> read_numbers(const Node& node, std::string_view what, std::size_t count, const Range& range,
                                                Diagnostics& diagnostics) {
  if (node.kind != Node::Kind::sequence || node.items.size() != count) {
    const std::string found =
        node.kind == Node::Kind::sequence ? fmt::format("a list of {}", node.items.size()) : config::describe(node);
    diagnostics.error(node.place, fmt::format("{} must be a list of {} numbers, not {}", what, count, found));
    return std::nullopt;
  }
  std::vector<double> numbers;
  for (const Node& item : node.items)
    if (const std::optional<double> number = config::read_number(item, what, range, diagnostics)) numbers.push_back(*number);
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

namespace {

std::optional<Quaterniond> quaternion_of(const Node& node, Diagnostics& diagnostics) {
  const std::optional<std::vector<double>> q = read_numbers(node, "orientation as a quaternion [x, y, z, w]", 4, {}, diagnostics);
  if (!q) return std::nullopt;
  const Quaterniond quaternion((*q)[3], (*q)[0], (*q)[1], (*q)[2]);
  // Anything that is not nearly of length 1 is no quaternion that someone meant (Euler angles, a wrong order of things).
  if (std::abs(quaternion.norm() - 1) > 1e-2) {
    diagnostics.error(node.place, fmt::format("a quaternion [x, y, z, w] must have length 1, not {:.6g}; "
                                              "{{axis: [0, 1, 0], degrees: 90}} is the other way to write an orientation",
                                              quaternion.norm()));
    return std::nullopt;
  }
  return quaternion.normalized();
}

std::optional<Quaterniond> axis_angle_of(const Node& node, Diagnostics& diagnostics) {
  Reader reader(node, "an orientation", diagnostics);
  const std::optional<Vector3d> axis = required_vector3(reader, "axis");
  const double degrees = reader.required_number("degrees");
  reader.finish();
  if (!axis || std::isnan(degrees)) return std::nullopt;
  if (!(axis->norm() > 0)) {
    diagnostics.error(node.find("axis")->place, "the axis of an orientation must not be zero");
    return std::nullopt;
  }
  return Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis->normalized()));
}

}  // namespace

Quaterniond orientation(Reader& reader, const Quaterniond& fallback, std::string_view key) {
  const Node* node = reader.find(key);
  if (node == nullptr) return fallback;
  if (node->kind == Node::Kind::map) return axis_angle_of(*node, reader.diagnostics()).value_or(fallback);
  if (node->kind == Node::Kind::sequence) return quaternion_of(*node, reader.diagnostics()).value_or(fallback);
  reader.diagnostics().error(
      node->place,
      fmt::format("{} must be a quaternion [x, y, z, w] or {{axis: [x, y, z], degrees: a}}, not {}", key, config::describe(*node)));
  return fallback;
}

const std::vector<Node>& list(Reader& reader, std::string_view key) {
  static const std::vector<Node> none;
  const Node* node = reader.find(key);
  if (node == nullptr || node->kind == Node::Kind::null) return none;
  if (node->kind == Node::Kind::sequence) return node->items;
  reader.diagnostics().error(node->place, fmt::format("{} must be a list, not {}", key, config::describe(*node)));
  return none;
}

std::optional<std::string> required_file(Reader& reader, std::string_view key, const std::filesystem::path& folder) {
  const Node* node = reader.require(key);
  if (node == nullptr) return std::nullopt;
  const std::optional<std::string> text = config::read_text(*node, key, reader.diagnostics());
  if (!text) return std::nullopt;
  const std::filesystem::path file = (folder / *text).lexically_normal();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    const std::string circle = config::circle_hint(file);
    reader.diagnostics().error(node->place, fmt::format("the file '{}' does not exist{}", file.string(),
                                                        circle.empty() ? "; names are relative to the scene file" : circle));
    return std::nullopt;
  }
  if (!std::filesystem::is_regular_file(status)) {
    reader.diagnostics().error(node->place, fmt::format("'{}' is not a file", file.string()));
    return std::nullopt;
  }
  return file.string();
}

std::optional<Kind> one_of(Reader& reader, const std::vector<std::string>& kinds, const std::string& what) {
  std::optional<Kind> found;
  bool several = false;
  for (const std::string& kind : kinds) {
    const Node* node = reader.find(kind);
    if (node == nullptr) continue;
    if (!found) {
      found = Kind{kind, node};
    } else {
      reader.diagnostics().error(node->place,
                                 fmt::format("{} has both '{}' and '{}'; only one is possible", what, found->name, kind));
      several = true;
    }
  }
  if (several) return std::nullopt;
  if (!found && reader.node().kind == Node::Kind::map)
    reader.diagnostics().error(reader.node().place, fmt::format("{} needs one of {}", what, fmt::join(kinds, ", ")));
  return found;
}

std::string to_text(const Vector3d& vector) {
  const Vector3d shown = vector + Vector3d::Zero();  // -0 becomes 0
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", shown.x(), shown.y(), shown.z());
}

}  // namespace firn::scene::detail
