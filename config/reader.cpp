#include "config/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "config/nearest.h"
#include "config/text.h"

namespace firn::config {
namespace {

// "a:1" is one text to YAML.
std::string colon_hint(const Node& node) {
  const bool joined = node.kind == Node::Kind::scalar && !node.quoted && node.scalar.find(':') != std::string::npos;
  return joined ? "; is a space missing after ':'?" : "";
}

}  // namespace

Reader::Reader(const Node& node, std::string what, Diagnostics& diagnostics)
    : node_(node), what_(std::move(what)), diagnostics_(diagnostics), is_map_(node.kind == Node::Kind::map) {
  if (is_map_) return;
  diagnostics_.error(node.place,
                     fmt::format("{} must be a map of 'key: value', not {}{}", what_, describe(node), colon_hint(node)));
}

bool Reader::has(std::string_view key) const { return node_.find(key) != nullptr; }

const Node* Reader::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return node_.find(key);
}

const Node* Reader::require(std::string_view key) {
  const Node* value = find(key);
  if (value == nullptr && is_map_) diagnostics_.error(node_.place, fmt::format("{} needs the key {}", what_, quote(key)));
  return value;
}

double Reader::number(std::string_view key, double fallback, const Range& range) {
  const Node* value = find(key);
  return value == nullptr ? fallback : read_number(*value, key, range, diagnostics_).value_or(fallback);
}

double Reader::required_number(std::string_view key, const Range& range) {
  constexpr double reported = std::numeric_limits<double>::quiet_NaN();
  const Node* value = require(key);
  return value == nullptr ? reported : read_number(*value, key, range, diagnostics_).value_or(reported);
}

std::int64_t Reader::integer(std::string_view key, std::int64_t fallback, const Range& range) {
  const Node* value = find(key);
  return value == nullptr ? fallback : read_integer(*value, key, range, diagnostics_).value_or(fallback);
}

bool Reader::boolean(std::string_view key, bool fallback) {
  const Node* value = find(key);
  return value == nullptr ? fallback : read_boolean(*value, key, diagnostics_).value_or(fallback);
}

std::string Reader::text(std::string_view key, std::string fallback) {
  const Node* value = find(key);
  return value == nullptr ? std::move(fallback) : read_text(*value, key, diagnostics_).value_or(std::move(fallback));
}

std::string Reader::required_text(std::string_view key) {
  const Node* value = require(key);
  return value == nullptr ? "" : read_text(*value, key, diagnostics_).value_or("");
}

Vector3 Reader::vector3(std::string_view key, const Vector3& fallback, const Range& range) {
  const Node* value = find(key);
  return value == nullptr ? fallback : read_vector3(*value, key, range, diagnostics_).value_or(fallback);
}

std::optional<Vector3> Reader::required_vector3(std::string_view key, const Range& range) {
  const Node* value = require(key);
  return value == nullptr ? std::nullopt : read_vector3(*value, key, range, diagnostics_);
}

std::string Reader::choice(std::string_view key, const std::vector<std::string>& choices, std::string fallback) {
  const Node* value = find(key);
  return value == nullptr ? std::move(fallback) : read_choice(*value, key, choices, diagnostics_).value_or(std::move(fallback));
}

void Reader::finish() {
  for (const Entry& entry : node_.entries) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    diagnostics_.error(entry.place, fmt::format("{} has no key {}{}", what_, quote(entry.key), suggestion(entry.key, known_)));
  }
}

}  // namespace firn::config
