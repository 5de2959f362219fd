#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <sstream>

#include "gpu/program.h"
#include "gpu/shader_source.h"

namespace firn::gpu {

namespace {

struct Place {
  std::size_t file = 0, line = 0;
};

struct Message {
  Place place;
  bool warning = false;
  std::string_view text;
};

// Takes the parts of a line off its front, as long as they are what is expected.
struct Reader {
  std::string_view rest;
  bool good = true;

  Reader& literal(std::string_view expected) {
    good = good && rest.starts_with(expected);
    if (good) rest.remove_prefix(expected.size());
    return *this;
  }
  Reader& optional(std::string_view expected) {
    if (rest.starts_with(expected)) rest.remove_prefix(expected.size());
    return *this;
  }
  Reader& number(std::size_t& value) {
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    good = good && error == std::errc();
    if (good) rest.remove_prefix(end - rest.data());
    return *this;
  }
  Reader& spaces() {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    return *this;
  }
  Reader& severity(bool& warning, std::string_view error_word, std::string_view warning_word) {
    warning = rest.starts_with(warning_word);
    return literal(warning ? warning_word : error_word);
  }
};

// 1:12(3): error: text
std::optional<Message> mesa_message(std::string_view line) {
  Message message;
  std::size_t column = 0;
  Reader reader{line};
  reader.number(message.place.file).literal(":").number(message.place.line).literal("(").number(column).literal("):").spaces();
  reader.optional("preprocessor ").severity(message.warning, "error", "warning").spaces().literal(":").spaces();
  message.text = reader.rest;
  return reader.good ? std::optional(message) : std::nullopt;
}

// 1(12) : error C1503: text
std::optional<Message> nvidia_message(std::string_view line) {
  Message message;
  Reader reader{line};
  reader.number(message.place.file).literal("(").number(message.place.line).literal(")").spaces().literal(":").spaces();
  reader.optional("fatal ").severity(message.warning, "error", "warning").spaces().optional(":").spaces();
  message.text = reader.rest;
  return reader.good ? std::optional(message) : std::nullopt;
}

// ERROR: 1:12: text
std::optional<Message> intel_message(std::string_view line) {
  Message message;
  Reader reader{line};
  reader.severity(message.warning, "ERROR", "WARNING").literal(":").spaces();
  reader.number(message.place.file).literal(":").number(message.place.line).literal(":").spaces();
  message.text = reader.rest;
  return reader.good ? std::optional(message) : std::nullopt;
}

// Where line `number` (from 1) of the whole text comes from.
Place place_of(const ShaderSource& source, std::size_t number) {
  std::size_t file = 0, first = 1, start = 1;  // line `start` of the text is line `first` of `file`
  std::size_t at = 0;
  for (const std::string_view line : lines_of(source.text)) {
    if (++at >= number) break;
    if (!line.starts_with(line_directive)) continue;
    std::istringstream directive{std::string(line.substr(line_directive.size()))};
    directive >> first >> file;
    start = at + 1;
  }
  return {file, first + number - start};
}

std::string mapped_line(std::string_view line, const ShaderSource& source) {
  for (const auto& parse : {mesa_message, nvidia_message, intel_message}) {
    const std::optional<Message> message = parse(line);
    if (!message) continue;
    const Place place = message->place.file == 0 ? place_of(source, message->place.line) : message->place;
    if (place.file >= source.files.size()) break;
    return fmt::format("{}:{}: {}: {}", source.files[place.file], place.line, message->warning ? "warning" : "error",
                       message->text);
  }
  return std::string(line);
}

}  // namespace

std::string mapped_log(std::string_view log, const ShaderSource& source) {
  log = log.substr(0, log.find('\0'));
  std::string mapped;
  for (std::string_view line : lines_of(log)) {
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.remove_suffix(1);
    if (line.empty()) continue;
    if (!mapped.empty()) mapped += '\n';
    mapped += mapped_line(line, source);
  }
  return mapped;
}

}  // namespace firn::gpu
