#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "config/nearest.h"
#include "config/numbers.h"
#include "config/reader.h"

namespace firn::config {
namespace {

bool is_plain(const Node& node) { return node.kind == Node::Kind::scalar && !node.quoted; }

std::string quotes_hint(const Node& node) {
  const bool number = node.kind == Node::Kind::scalar && node.quoted && parse_number(node.scalar).has_value();
  return number ? "; remove the quotes" : "";
}

bool check_range(double value, const Node& node, std::string_view what, const Range& range, Diagnostics& diagnostics) {
  if (contains(range, value)) return true;
  diagnostics.error(node.place, fmt::format("{} must be {}, not {}", what, describe(range), node.scalar));
  return false;
}

}  // namespace

bool contains(const Range& range, double value) {
  const bool above = range.open_min ? value > range.min : value >= range.min;
  const bool below = range.open_max ? value < range.max : value <= range.max;
  return above && below;
}

std::string describe(const Range& range) {
  const bool has_min = std::isfinite(range.min);
  const bool has_max = std::isfinite(range.max);
  std::string min = fmt::format("{} {}", range.open_min ? "greater than" : "at least", range.min);
  std::string max = fmt::format("{} {}", range.open_max ? "less than" : "at most", range.max);
  if (!has_min && !has_max) return "any number";
  if (!has_max) return min;
  if (!has_min) return max;
  if (range.open_min || range.open_max) return min + " and " + max;
  return range.min == range.max ? fmt::format("{}", range.min) : fmt::format("between {} and {}", range.min, range.max);
}

std::optional<double> read_number(const Node& node, std::string_view what, const Range& range, Diagnostics& diagnostics) {
  const auto value = is_plain(node) ? parse_number(node.scalar) : std::nullopt;
  if (value) return check_range(*value, node, what, range, diagnostics) ? value : std::nullopt;
  if (is_plain(node) && means_not_finite(node.scalar)) {
    diagnostics.error(node.place, fmt::format("{} must be a finite number, not {}", what, describe(node)));
  } else {
    const std::string hint = is_plain(node) ? number_hint(node.scalar) : quotes_hint(node);
    diagnostics.error(node.place, fmt::format("{} must be a number, not {}{}", what, describe(node), hint));
  }
  return std::nullopt;
}

std::optional<std::int64_t> read_integer(const Node& node, std::string_view what, const Range& range, Diagnostics& diagnostics) {
  const auto number = is_plain(node) ? parse_number(node.scalar) : std::nullopt;
  const auto whole = number ? parse_whole(node.scalar) : std::nullopt;
  if (whole) return check_range(static_cast<double>(*whole), node, what, range, diagnostics) ? whole : std::nullopt;
  if (number && std::trunc(*number) == *number) {
    diagnostics.error(node.place, fmt::format("{} must be a whole number of at most 64 bits, not {}", what, describe(node)));
  } else if (is_plain(node) && means_not_finite(node.scalar)) {
    diagnostics.error(node.place, fmt::format("{} must be a finite whole number, not {}", what, describe(node)));
  } else {
    const std::string hint = is_plain(node) ? number_hint(node.scalar) : quotes_hint(node);
    diagnostics.error(node.place, fmt::format("{} must be a whole number, not {}{}", what, describe(node), hint));
  }
  return std::nullopt;
}

std::optional<bool> read_boolean(const Node& node, std::string_view what, Diagnostics& diagnostics) {
  constexpr std::array<std::string_view, 3> yes = {"true", "True", "TRUE"};
  constexpr std::array<std::string_view, 3> no = {"false", "False", "FALSE"};
  if (is_plain(node)) {
    if (std::find(yes.begin(), yes.end(), node.scalar) != yes.end()) return true;
    if (std::find(no.begin(), no.end(), node.scalar) != no.end()) return false;
  }
  diagnostics.error(node.place, fmt::format("{} must be true or false, not {}; write true or false{}", what, describe(node),
                                            node.quoted ? " without quotes" : ""));
  return std::nullopt;
}

std::optional<std::string> read_text(const Node& node, std::string_view what, Diagnostics& diagnostics) {
  if (node.kind == Node::Kind::scalar) return node.scalar;
  diagnostics.error(node.place, fmt::format("{} must be a text, not {}", what, describe(node)));
  return std::nullopt;
}

std::optional<Vector3> read_vector3(const Node& node, std::string_view what, const Range& range, Diagnostics& diagnostics) {
  if (node.kind != Node::Kind::sequence || node.items.size() != 3) {
    const std::string found = node.kind == Node::Kind::sequence ? fmt::format("a list of {}", node.items.size()) : describe(node);
    diagnostics.error(node.place, fmt::format("{} must be a list of 3 numbers like [0, 1.5, 0], not {}", what, found));
    return std::nullopt;
  }
  Vector3 result{};
  bool complete = true;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto value = read_number(node.items[i], fmt::format("{}[{}]", what, i), range, diagnostics);
    complete = complete && value;
    result[i] = value.value_or(0);
  }
  return complete ? std::optional(result) : std::nullopt;
}

std::optional<std::string> read_choice(const Node& node, std::string_view what, const std::vector<std::string>& choices,
                                       Diagnostics& diagnostics) {
  auto text = read_text(node, what, diagnostics);
  if (!text || std::find(choices.begin(), choices.end(), *text) != choices.end()) return text;
  diagnostics.error(node.place, fmt::format("{} cannot be {}{}", what, describe(node), suggestion(*text, choices)));
  return std::nullopt;
}

}  // namespace firn::config
