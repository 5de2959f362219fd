#include "gpu/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>

#include "gpu/program.h"

namespace firn::gpu {

namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!fs::is_regular_file(file) || !stream) throw ShaderError(fmt::format("{}: error: the file cannot be read", file.string()));
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // a byte order mark is no GLSL
  return text;
}

bool holds(const ShaderSource& source, const fs::path& file) {
  std::error_code none;  // the file "generated" may not exist
  return std::any_of(source.files.begin() + 1, source.files.end(),
                     [&](const std::string& known) { return fs::equivalent(known, file, none); });
}

// The line without comments; `in_comment` tells whether a /* */ is open before it, and after it.
std::string without_comments(std::string_view line, bool& in_comment) {
  std::string code;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const std::string_view pair = line.substr(at, 2);
    if (in_comment) {
      if (pair == "*/") in_comment = false, ++at;
    } else if (pair == "/*") {
      in_comment = true, ++at;
      code += ' ';
    } else if (pair == "//") {
      break;
    } else {
      code += line[at];
    }
  }
  return code;
}

bool is_directive(const std::string& code, const std::string& name) {
  std::istringstream stream(code);
  char hash = 0;
  std::string word;
  stream >> hash >> word;
  return hash == '#' && word.substr(0, word.find_first_of("\"<")) == name;
}

// What stands between the quotes of an #include, nothing where it is written otherwise.
std::optional<std::string> include_path(const std::string& code) {
  const std::size_t first = code.find('"');
  const std::size_t last = code.find('"', first + 1);
  if (first == std::string::npos || last == std::string::npos) return std::nullopt;
  if (last == first + 1 || code.find_first_not_of(" \t", last + 1) != std::string::npos) return std::nullopt;
  return code.substr(first + 1, last - first - 1);
}

fs::path find_include(const std::string& path, const std::string& place, const fs::path& including_folder,
                      std::span<const fs::path> include_dirs) {
  std::vector<fs::path> folders{including_folder.empty() ? fs::path(".") : including_folder};
  folders.insert(folders.end(), include_dirs.begin(), include_dirs.end());
  std::string searched;
  for (const fs::path& folder : folders) {
    fs::path candidate = (folder / path).lexically_normal();
    if (fs::is_regular_file(candidate)) return candidate;
    searched += fmt::format("{}{}", searched.empty() ? "" : ", ", folder.string());
  }
  throw ShaderError(fmt::format("{}: error: no file '{}' to include; searched: {}", place, path, searched));
}

void append(ShaderSource& source, const fs::path& file, std::span<const fs::path> include_dirs) {
  if (holds(source, file)) return;
  const std::string text = read(file);
  const std::size_t id = source.files.size();
  source.files.push_back(file.string());
  source.text += fmt::format("#line 1 {}\n", id);

  bool in_comment = false;
  int number = 0;
  for (std::string_view line : lines_of(text)) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number;
    const bool in_comment_before = in_comment;
    const std::string code = without_comments(line, in_comment);
    if (!is_directive(code, "include")) {
      // A #line of the user's own would make ours lie.
      const bool own = is_directive(code, "line") || line.starts_with(line_directive);
      source.text += own ? "\n" : fmt::format("{}\n", line);
      continue;
    }
    const std::string place = fmt::format("{}:{}", file.string(), number);
    if (in_comment_before || in_comment) {
      throw ShaderError(
          fmt::format("{}: error: a comment over several lines must not begin or end on the line of an #include", place));
    }
    const std::optional<std::string> path = include_path(code);
    if (!path) throw ShaderError(fmt::format("{}: error: an include is written #include \"path\"", place));
    append(source, find_include(*path, place, file.parent_path(), include_dirs), include_dirs);
    source.text += fmt::format("#line {} {}\n", number + 1, id);
  }
}

}  // namespace

void append_file(ShaderSource& source, const fs::path& file, std::span<const fs::path> include_dirs) {
  if (source.files.empty()) source.files.emplace_back("generated");
  if (!source.text.empty() && !source.text.ends_with('\n')) source.text += '\n';
  append(source, file, include_dirs);
  // Text that is generated after it counts its lines in the whole text.
  const auto lines = std::count(source.text.begin(), source.text.end(), '\n');
  source.text += fmt::format("#line {} 0\n", lines + 2);
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string with_plain_lines(std::string_view text) {
  std::string plain(text);
  for (std::size_t start = 0; start < plain.size();) {
    if (std::string_view(plain).substr(start).starts_with(line_directive)) plain.replace(start, 2, "//");
    start = std::min(plain.find('\n', start), plain.size()) + 1;
  }
  return plain;
}

}  // namespace firn::gpu
