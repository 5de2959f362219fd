#include "app/try_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

namespace firn::app {
namespace {

struct Summary {
  double min = std::numeric_limits<double>::infinity(), max = -min, sum = 0;
  std::size_t values = 0, not_numbers = 0;
};

template <typename T>
Summary summary_of(std::span<const std::byte> bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  Summary result;
  result.values = values.size();
  for (const T entry : values) {
    const auto value = static_cast<double>(entry);
    if (std::isnan(value)) {
      ++result.not_numbers;
      continue;
    }
    result.min = std::min(result.min, value);
    result.max = std::max(result.max, value);
    result.sum += value;
  }
  return result;
}

Summary summary_of(graph::ElementType type, std::span<const std::byte> bytes) {
  switch (array_kind(type)) {
    case scene::NpyKind::int32:
      return summary_of<std::int32_t>(bytes);
    case scene::NpyKind::uint32:
      return summary_of<std::uint32_t>(bytes);
    default:
      return summary_of<float>(bytes);
  }
}

// JSON knows no infinities.
nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(fmt::format("{}", value));
}

}  // namespace

void print_outputs(const execution::Execution& execution, bool json) {
  const graph::Plan& plan = execution.plan();
  const graph::PlannedStage& stage = plan.stages.front();
  nlohmann::json list = nlohmann::json::array();
  if (!json)
    fmt::print("{:<26} {:<6} {:<18} {:>13} {:>13} {:>13} {:>6}  {}\n", "output", "type", "shape", "min", "max", "sum", "NaN",
               "unit");
  for (std::size_t p = 0; p < stage.spec.ports.size(); ++p) {
    const graph::Port& port = stage.spec.ports[p];
    if (stage.buffers[p] < 0 || !graph::writes(port.access) || graph::is_texel(port.type)) continue;
    const graph::PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(stage.buffers[p])];
    const Summary s = summary_of(buffer.type, read_buffer(execution, buffer.name));
    const std::string shape = scene::to_string(array_shape(plan, buffer));
    const bool none = s.values == s.not_numbers;
    if (json) {
      nlohmann::json row = {{"port", port.name}, {"type", graph::name(port.type)}, {"shape", array_shape(plan, buffer)},
                            {"unit", port.unit}, {"sum", number(s.sum)},           {"nan", s.not_numbers}};
      row["min"] = none ? nlohmann::json() : number(s.min);
      row["max"] = none ? nlohmann::json() : number(s.max);
      list.push_back(row);
    } else if (none) {
      fmt::print("{:<26} {:<6} {:<18} {:>13} {:>13} {:>13} {:>6}  {}\n", port.name, graph::name(port.type), shape, "-", "-", "-",
                 s.not_numbers, port.unit);
    } else {
      fmt::print("{:<26} {:<6} {:<18} {:>13.6g} {:>13.6g} {:>13.6g} {:>6}  {}\n", port.name, graph::name(port.type), shape, s.min,
                 s.max, s.sum, s.not_numbers, port.unit);
    }
  }
  if (json) fmt::print("{}\n", list.dump(2));
}

}  // namespace firn::app
