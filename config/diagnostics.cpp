#include "config/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace firn::config {
namespace {

// What is found twice is told once: a --set for a stage that setup and step have, or a part that is included twice.
std::string lines(const Diagnostics& diagnostics) {
  std::string text;
  std::unordered_set<std::string> told;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    const auto [line, is_new] = told.insert(to_string(diagnostic));
    if (!is_new) continue;
    if (!text.empty()) text += '\n';
    text += *line;
  }
  return text;
}

}  // namespace

std::string to_string(const Place& place) {
  std::string text = place.file;
  for (const int number : {place.line, place.column}) {
    if (number <= 0) break;
    if (!text.empty()) text += ':';
    text += std::to_string(number);
  }
  return text;
}

std::string to_string(const Diagnostic& diagnostic) {
  const std::string place = to_string(diagnostic.place);
  const char* severity = diagnostic.severity == Severity::error ? "error" : "warning";
  return fmt::format("{}{}{}: {}", place, place.empty() ? "" : ": ", severity, diagnostic.text);
}

void Diagnostics::error(Place place, std::string text) { list_.push_back({Severity::error, std::move(place), std::move(text)}); }

void Diagnostics::warning(Place place, std::string text) {
  list_.push_back({Severity::warning, std::move(place), std::move(text)});
}

void Diagnostics::append(const Diagnostics& other) {
  const std::vector<Diagnostic> copy = other.list_;  // `other` may be this very object
  list_.insert(list_.end(), copy.begin(), copy.end());
}

bool Diagnostics::has_errors() const {
  return std::any_of(list_.begin(), list_.end(),
                     [](const Diagnostic& diagnostic) { return diagnostic.severity == Severity::error; });
}

InputError::InputError(Diagnostics diagnostics) : std::runtime_error(lines(diagnostics)), diagnostics_(std::move(diagnostics)) {}

void throw_if_errors(const Diagnostics& diagnostics) {
  if (diagnostics.has_errors()) throw InputError(diagnostics);
}

}  // namespace firn::config
