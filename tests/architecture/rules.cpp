#include "tests/architecture/rules.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace firn::architecture {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> every_room = {"app",   "bench",  "config", "gpu", "graph", "graph/execution",
                                             "scene", "stages", "tests"};

// Which room may know which. The order of the rooms is the way that data goes.
const std::map<std::string, std::vector<std::string>> rooms = {
    {"config", {"config"}},
    {"gpu", {"gpu"}},
    {"graph", {"graph", "config"}},
    {"graph/execution", {"graph/execution", "graph", "gpu", "config"}},
    {"scene", {"scene", "config"}},
    {"stages", {"stages", "graph", "scene", "config"}},
    {"app", every_room},
    {"bench", every_room},
    {"tests", every_room},
};

struct Include {
  int line = 0;
  bool quoted = false;
  std::string target;
};

std::string_view skip_space(std::string_view text) {
  const std::size_t start = text.find_first_not_of(" \t");
  return start == std::string_view::npos ? std::string_view() : text.substr(start);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::optional<Include> parse_include(std::string_view line) {
  line = skip_space(line);
  if (line.empty() || line.front() != '#') return std::nullopt;
  line = skip_space(line.substr(1));
  constexpr std::string_view keyword = "include";
  if (line.substr(0, keyword.size()) != keyword) return std::nullopt;
  line = skip_space(line.substr(keyword.size()));
  if (line.empty() || (line.front() != '"' && line.front() != '<')) return std::nullopt;
  const bool quoted = line.front() == '"';
  const std::size_t end = line.find(quoted ? '"' : '>', 1);
  if (end == std::string_view::npos) return std::nullopt;
  return Include{0, quoted, std::string(line.substr(1, end - 1))};
}

std::vector<Include> includes_of(const std::string& text) {
  std::vector<Include> includes;
  int number = 0;
  for (const std::string& line : lines_of(text)) {
    ++number;
    if (std::optional<Include> include = parse_include(line)) {
      include->line = number;
      includes.push_back(*include);
    }
  }
  return includes;
}

bool has_extension(const std::string& path, const std::vector<std::string>& extensions) {
  const std::string extension = fs::path(path).extension().string();
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](const std::string& beginning) { return text.starts_with(beginning); });
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string at(const SourceFile& file, int line) { return file.path + ":" + std::to_string(line) + ": "; }

// Files directly in stages/ are shared helpers; deeper ones belong to one stage.
bool is_stage(const std::string& path) {
  return room_of(path) == "stages" && path.find('/', std::string("stages/").size()) != std::string::npos;
}

std::string without_extension(const std::string& path) { return fs::path(path).replace_extension().generic_string(); }

std::optional<std::string> forbidden(const SourceFile& file, const std::string& room, const Include& include) {
  // GLSL in a string.
  if (has_extension(include.target, {".glsl", ".comp", ".vert", ".frag"})) return std::nullopt;
  const std::string named = "includes " + include.target;
  if (!include.quoted && starts_with_any(include.target, {"glad/", "EGL/", "GL/", "GLES", "KHR/"})) {
    if (room == "gpu") return std::nullopt;
    return named + ", which only gpu/ may see";
  }
  const std::string target_room = room_of(include.target);
  if (target_room.empty()) {
    if (!include.quoted) return std::nullopt;
    return named + ", which lies in no room; write the path from the root";
  }
  const std::vector<std::string> allowed = allowed_rooms(room);
  if (!contains(allowed, target_room)) return named + "; " + room + "/ may include only " + joined(allowed);
  if (room == "stages" && is_stage(include.target) && file.path != "stages/register.cpp" &&
      without_extension(file.path) != without_extension(include.target)) {
    return named + ", another stage; what two stages share belongs directly in stages/";
  }
  return std::nullopt;
}

}  // namespace

std::vector<SourceFile> read_tree(const std::string& root) {
  static const std::vector<std::string> extensions = {".h",  ".cpp", ".comp", ".vert", ".frag", ".glsl", ".cmake", ".txt", ".md",
                                                      ".py", ".sh",  ".yaml", ".yml",  ".json", ".cff",  ".obj",   ""};
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file()) found.push_back(entry.path());
    if (!entry.is_directory() || name == ".git" || name == "out" || name.starts_with("build")) continue;
    if (name.starts_with(".") && name != ".ci") continue;
    for (const fs::directory_entry& below : fs::recursive_directory_iterator(entry.path())) {
      if (below.is_regular_file()) found.push_back(below.path());
    }
  }
  std::vector<SourceFile> files;
  for (const fs::path& path : found) {
    if (!has_extension(path.string(), extensions)) continue;
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    if (stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
    if (!stream.is_open() || stream.bad() || text.fail()) throw std::runtime_error(path.string() + ": cannot be read");
    files.push_back({path.lexically_relative(root).generic_string(), text.str()});
  }
  std::sort(files.begin(), files.end(), [](const SourceFile& left, const SourceFile& right) { return left.path < right.path; });
  return files;
}

std::vector<std::string> allowed_rooms(const std::string& room) {
  const auto found = rooms.find(room);
  return found == rooms.end() ? std::vector<std::string>() : found->second;
}

std::string room_of(const std::string& path) {
  if (path.starts_with("graph/execution/")) return "graph/execution";
  const std::size_t slash = path.find('/');
  if (slash == std::string::npos) return "";
  const std::string folder = path.substr(0, slash);
  return rooms.contains(folder) ? folder : "";
}

Violations check_includes(const std::vector<SourceFile>& files) {
  Violations violations;
  for (const SourceFile& file : files) {
    if (!has_extension(file.path, {".h", ".cpp"})) continue;
    const std::string room = room_of(file.path);
    if (room.empty()) {
      violations.push_back(at(file, 1) + "C++ outside the rooms " + joined(every_room));
      continue;
    }
    for (const Include& include : includes_of(file.text)) {
      if (const std::optional<std::string> why = forbidden(file, room, include)) {
        violations.push_back(at(file, include.line) + *why);
      }
    }
  }
  return violations;
}

Violations check_lengths(const std::vector<SourceFile>& files) {
  static const std::vector<std::string> source = {".h", ".cpp", ".comp", ".vert", ".frag", ".glsl", ".cmake", ".py", ".sh"};
  Violations violations;
  for (const SourceFile& file : files) {
    if (!has_extension(file.path, source)) continue;
    const int length = static_cast<int>(lines_of(file.text).size());
    if (length > longest_file) {
      violations.push_back(at(file, length) + "longer than " + std::to_string(longest_file) + " lines; split it");
    }
  }
  return violations;
}

Violations check_machine_paths(const std::vector<SourceFile>& files) {
  // In two halves, or this file would break its own rule.
  static const std::array<std::string, 4> places = {std::string("/wo") + "rk/", std::string("/ro") + "ot/",
                                                    std::string("/ho") + "me/", std::string("/tm") + "p/build"};
  Violations violations;
  for (const SourceFile& file : files) {
    int number = 0;
    for (const std::string& line : lines_of(file.text)) {
      ++number;
      for (const std::string& place : places) {
        const std::size_t found = line.find(place);
        if (found == std::string::npos) continue;
        // "frame/wo..." or "a/ro..." is a relative path that happens to hold such a folder.
        if (found > 0 && (std::isalnum(static_cast<unsigned char>(line[found - 1])) != 0 || line[found - 1] == '.')) continue;
        violations.push_back(at(file, number) + "names " + place + ", a place of one machine");
      }
    }
  }
  return violations;
}

Violations check_test_names(const std::vector<SourceFile>& files) {
  constexpr std::string_view start = "TEST_CASE(\"";
  Violations violations;
  for (const SourceFile& file : files) {
    if (room_of(file.path) != "tests") continue;
    int number = 0;
    for (const std::string& line : lines_of(file.text)) {
      ++number;
      if (!line.starts_with(start)) continue;
      const std::string name = line.substr(start.size(), line.find_first_of('"', start.size()) - start.size());
      const auto brackets = std::count(name.begin(), name.end(), '[') - std::count(name.begin(), name.end(), ']');
      if (name.starts_with('-') || name.find_first_of(";\\") != std::string::npos || brackets != 0) {
        violations.push_back(at(file, number) +
                             "ctest cannot run this test case by its name; begin with a letter, and do without " +
                             "semicolon, backslash and lone bracket");
      }
    }
  }
  return violations;
}

}  // namespace firn::architecture
