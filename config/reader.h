#pragma once

// Typed reading of nodes. Every function reports what is wrong to the diagnostics and goes on with the fallback, so that all
// errors of a file are found in one pass.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/node.h"

namespace firn::config {

using Vector3 = std::array<double, 3>;

// Closed unless `open_*`: {0, infinity, true} is "greater than 0".
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;
  bool open_max = false;
};
bool contains(const Range& range, double value);
std::string describe(const Range& range);  // "greater than 0", "between 0 and 0.5", "at least 1"

// Single values. `what` names the value in the error ("density"). Numbers must be finite: NaN and infinity are refused.
// Returns nothing where an error was reported.
std::optional<double> read_number(const Node& node, std::string_view what, const Range& range, Diagnostics& diagnostics);
std::optional<std::int64_t> read_integer(const Node& node, std::string_view what, const Range& range, Diagnostics& diagnostics);
std::optional<bool> read_boolean(const Node& node, std::string_view what, Diagnostics& diagnostics);
std::optional<std::string> read_text(const Node& node, std::string_view what, Diagnostics& diagnostics);
std::optional<Vector3> read_vector3(const Node& node, std::string_view what, const Range& range, Diagnostics& diagnostics);
std::optional<std::string> read_choice(const Node& node, std::string_view what, const std::vector<std::string>& choices,
                                       Diagnostics& diagnostics);

// One map, read key by key. finish() reports every key that nobody asked for, with the nearest of those asked for.
class Reader {
 public:
  // `what` names the map in errors ("a material"). A node that is no map is reported at once, then reads as empty;
  // required keys of it are then not reported as missing again.
  Reader(const Node& node, std::string what, Diagnostics& diagnostics);

  [[nodiscard]] bool has(std::string_view key) const;
  const Node* find(std::string_view key);     // marks the key as known
  const Node* require(std::string_view key);  // reports a missing key

  double number(std::string_view key, double fallback, const Range& range = {});
  double required_number(std::string_view key, const Range& range = {});  // NaN where it was reported
  std::int64_t integer(std::string_view key, std::int64_t fallback, const Range& range = {});
  bool boolean(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::string fallback);
  std::string required_text(std::string_view key);
  Vector3 vector3(std::string_view key, const Vector3& fallback, const Range& range = {});
  std::optional<Vector3> required_vector3(std::string_view key, const Range& range = {});
  std::string choice(std::string_view key, const std::vector<std::string>& choices, std::string fallback);

  void finish();

  [[nodiscard]] const Node& node() const { return node_; }
  [[nodiscard]] Diagnostics& diagnostics() { return diagnostics_; }

 private:
  const Node& node_;
  std::string what_;
  Diagnostics& diagnostics_;
  bool is_map_ = true;
  std::vector<std::string> known_;
};

}  // namespace firn::config
