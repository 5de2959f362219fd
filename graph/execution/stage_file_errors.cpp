#include "graph/execution/stage_file_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/nearest.h"

namespace firn::execution {
namespace {

bool in_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; }

// Takes the next name or other character off the front of a line; empty at its end.
std::string_view next_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  std::size_t length = line.empty() ? 0 : 1;
  if (length == 1 && in_name(line.front()))
    while (length < line.size() && in_name(line[length])) ++length;
  const std::string_view word = line.substr(0, length);
  line.remove_prefix(length);
  return word;
}

bool is_type(std::string_view word) {
  constexpr std::array plain{"void", "bool", "int", "uint", "float", "samplerBuffer", "isamplerBuffer", "usamplerBuffer"};
  constexpr std::array families{"vec",      "ivec",     "uvec",  "bvec",   "mat",   "sampler",
                                "isampler", "usampler", "image", "iimage", "uimage"};
  if (std::ranges::find(plain, word) != plain.end()) return true;
  return std::ranges::any_of(families, [&](std::string_view family) {
    return word.starts_with(family) && word.size() > family.size() && word[family.size()] >= '2' && word[family.size()] <= '4';
  });
}

// Names that are declared in a text: all of those that are generated and of the file itself, of what it includes the functions.
std::vector<std::string> declared_names(const gpu::ShaderSource& source) {
  std::vector<std::string> names;
  const auto add = [&](std::string_view name) {
    if (!name.empty() && in_name(name.front()) && std::ranges::find(names, name) == names.end()) names.emplace_back(name);
  };
  constexpr std::string_view line_directive = "#line ";
  std::size_t file = 0;
  for (std::string_view rest = source.text; !rest.empty();) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    if (line.starts_with(line_directive)) {
      const std::string_view number = line.substr(line.rfind(' ') + 1);
      std::from_chars(number.data(), number.data() + number.size(), file);
      continue;
    }
    std::string_view before;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      std::string_view behind = line;
      if (before == "define" || (is_type(before) && (file <= 1 || next_word(behind) == "("))) add(word);
      before = word;
    }
  }
  return names;
}

// The name that a driver says it does not know: Mesa's "`foo' undeclared", NVIDIA's "undefined variable "foo"", Intel's and AMD's
// "'foo' : undeclared identifier", and their words for functions.
std::optional<std::string> unknown_name(std::string_view message) {
  constexpr std::array<std::string_view, 6> signs{"undeclared",
                                                  "undefined variable",
                                                  "no function with name",
                                                  "no matching overloaded function",
                                                  "unable to find compatible overloaded function",
                                                  "unknown identifier"};
  if (std::ranges::none_of(signs, [&](std::string_view sign) { return message.find(sign) != std::string_view::npos; }))
    return std::nullopt;
  const std::size_t quote = message.find_first_of("`'\"");
  if (quote == std::string_view::npos) return std::nullopt;
  std::string_view rest = message.substr(quote + 1);
  return std::string(next_word(rest));
}

// "file:12: error: text".
std::optional<config::Diagnostic> placed(std::string_view line) {
  for (const auto severity : {config::Severity::error, config::Severity::warning}) {
    const std::string_view sign = severity == config::Severity::error ? ": error: " : ": warning: ";
    const std::size_t end = line.find(sign);
    if (end == std::string_view::npos) continue;
    const std::string_view place = line.substr(0, end);
    const std::size_t colon = place.rfind(':');
    int number = 0;
    if (colon != std::string_view::npos) std::from_chars(place.data() + colon + 1, place.data() + end, number);
    const std::string file(number > 0 ? place.substr(0, colon) : place);
    return config::Diagnostic{severity, {file, number, 0}, std::string(line.substr(end + sign.size()))};
  }
  return std::nullopt;
}

}  // namespace

bool is_stage_file(const std::string& kernel) { return std::filesystem::path(kernel).is_absolute(); }

config::Diagnostics stage_file_errors(std::string_view what, const gpu::ShaderSource& source, const std::string& file) {
  const std::vector<std::string> declared = declared_names(source);
  config::Diagnostics diagnostics;
  std::string title;  // what the driver says of no line
  while (!what.empty()) {
    const std::string_view line = what.substr(0, what.find('\n'));
    what.remove_prefix(std::min(line.size() + 1, what.size()));
    const std::optional<config::Diagnostic> one = placed(line);
    if (!one) {
      title += fmt::format("{}{}", title.empty() ? "" : " ", line);
    } else if (one->severity == config::Severity::warning) {
      diagnostics.warning(one->place, one->text);
    } else {
      const std::optional<std::string> name = unknown_name(one->text);
      const auto near =
          name && std::ranges::find(declared, *name) == declared.end() ? config::nearest(*name, declared) : std::nullopt;
      diagnostics.error(one->place, near ? fmt::format("{}; did you mean '{}'?", one->text, *near) : one->text);
    }
  }
  if (!diagnostics.has_errors()) diagnostics.error({file, 0, 0}, title);
  return diagnostics;
}

}  // namespace firn::execution
