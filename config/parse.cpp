#include <fmt/format.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include "config/nearest.h"
#include "config/node.h"
#include "config/parsed.h"
#include "config/syntax_errors.h"
#include "config/text.h"
#include "config/tree_builder.h"

namespace firn::config {
namespace {

constexpr std::size_t largest_file = std::size_t{64} * 1024 * 1024;

// A name in the same folder that is nearly the one asked for.
std::string nearest_file(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  std::vector<std::string> names;
  for (std::filesystem::directory_iterator file(folder, error), end; !error && file != end; file.increment(error)) {
    names.push_back(file->path().filename().string());
  }
  const auto near = nearest(path.filename().string(), names);
  return near ? fmt::format("; did you mean '{}'?", (path.parent_path() / *near).string()) : "";
}

std::optional<std::string> read(const std::filesystem::path& path, Diagnostics& diagnostics) {
  const Place place{path.string(), 0, 0};
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    diagnostics.error(place, "there is no such file" + nearest_file(path));
    return std::nullopt;
  }
  if (std::filesystem::is_directory(status)) {
    diagnostics.error(place, "this is a directory, not a file");
    return std::nullopt;
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    diagnostics.error(place, fmt::format("the file cannot be opened: {}", std::strerror(errno)));
    return std::nullopt;
  }
  // Read in pieces: pipes and devices tell no size.
  std::string text;
  std::string piece(65536, '\0');
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())), file.gcount() > 0) {
    text.append(piece, 0, static_cast<std::size_t>(file.gcount()));
    if (text.size() > largest_file) {
      diagnostics.error(place, fmt::format("the file is larger than {} MiB", largest_file >> 20U));
      return std::nullopt;
    }
  }
  if (file.bad()) {
    diagnostics.error(place, fmt::format("the file cannot be read: {}", std::strerror(errno)));
    return std::nullopt;
  }
  return text;
}

}  // namespace

Node parse(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  return parse_broken(text, file, diagnostics).root;
}

Parsed parse_broken(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  const std::string normal = normalise(text);
  const Lines lines(normal, file);
  if (!is_text(normal, lines, diagnostics)) return {{}, Place{file, 1, 1}};
  TreeBuilder builder(lines, diagnostics);
  std::optional<Diagnostic> failure;
  try {
    std::istringstream stream(normal);
    YAML::Parser parser(stream);
    // Asked a second time, for a second document; never a third: yaml-cpp can stand still and yet say there is more.
    if (parser.HandleNextDocument(builder)) parser.HandleNextDocument(builder);
  } catch (const Stop& stop) {
    failure = {Severity::error, lines.place(stop.mark.line, stop.mark.column), stop.text};
  } catch (const YAML::Exception& exception) {
    failure = explain(exception, builder, lines);
  }
  if (const auto quote_mark = unclosed_quote(normal, builder, lines)) {
    failure = {Severity::error, *quote_mark, "the text that begins with this quote is never closed"};
  }
  const std::optional<Place> bracket = builder.outermost_open_bracket();
  Parsed parsed{builder.tree(!failure), {}};
  if (failure) {
    diagnostics.error(failure->place, failure->text);
    parsed.broken_at = bracket.value_or(failure->place);
  } else if (!builder.has_document()) {
    diagnostics.error({file, 0, 0}, "the file is empty");
  }
  return parsed;
}

Node load(const std::filesystem::path& path, Diagnostics& diagnostics) {
  const std::optional<std::string> text = read(path, diagnostics);
  return text ? parse(*text, path.string(), diagnostics) : Node{};
}

}  // namespace firn::config
