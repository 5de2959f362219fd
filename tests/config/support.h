#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "config/node.h"
#include "tests/catch.h"

namespace firn::test {

// A text that must be free of errors.
inline config::Node parse_good(std::string_view text) {
  config::Diagnostics diagnostics;
  config::Node node = config::parse(text, "a.yaml", diagnostics);
  CAPTURE(text);
  for (const config::Diagnostic& diagnostic : diagnostics.all()) FAIL(to_string(diagnostic));
  return node;
}

inline std::vector<std::string> texts(const config::Diagnostics& diagnostics) {
  std::vector<std::string> lines;
  for (const config::Diagnostic& diagnostic : diagnostics.all()) lines.push_back(to_string(diagnostic));
  return lines;
}

inline std::vector<std::string> errors_of(std::string_view text) {
  config::Diagnostics diagnostics;
  config::parse(text, "a.yaml", diagnostics);
  return texts(diagnostics);
}

inline bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

// Equal in everything but the places.
inline bool same(const config::Node& a, const config::Node& b) {
  return a.kind == b.kind && a.scalar == b.scalar && a.quoted == b.quoted &&
         std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), same) &&
         std::equal(a.entries.begin(), a.entries.end(), b.entries.begin(), b.entries.end(),
                    [](const config::Entry& x, const config::Entry& y) { return x.key == y.key && same(x.value, y.value); });
}

}  // namespace firn::test
