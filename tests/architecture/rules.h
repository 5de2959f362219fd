#pragma once

#include <string>
#include <vector>

// The rules of the tree that no compiler holds: which room may include which, how long a file may be, and that the project names no
// place of the machine it was written on. Rules look at texts only, so that each can be shown a made-up offender.

namespace firn::architecture {

struct SourceFile {
  std::string path;  // from the root, with forward slashes: "stages/mpm/grid_forces.cpp"
  std::string text;
};

// One broken rule, as "path:line: what is wrong; what would be right".
using Violations = std::vector<std::string>;

// The longest a file of source may be, in lines.
constexpr int longest_file = 400;

// All text files of the project below `root`: its own folders and the files of the root itself. Build folders, results of runs and
// other hidden folders are not among them. Sorted by path. Throws std::runtime_error when a file cannot be read.
std::vector<SourceFile> read_tree(const std::string& root);

// The rooms that `room` may include, itself among them; empty for a folder that is no room.
std::vector<std::string> allowed_rooms(const std::string& room);

// The room a path belongs to: its first folder, or "graph/execution" for what lies there; empty when that is no room.
std::string room_of(const std::string& path);

// Includes: a quoted include names a file by its path from the root, in a room that the including room may know; only gpu/ sees
// glad, EGL and GL; no stage includes another stage.
Violations check_includes(const std::vector<SourceFile>& files);

// Files of source (C++, GLSL, CMake, Python) of at most `longest_file` lines.
Violations check_lengths(const std::vector<SourceFile>& files);

// No absolute path of the machine the project was written on.
Violations check_machine_paths(const std::vector<SourceFile>& files);

// Names of test cases that reach the test unharmed: ctest runs each by its name, which CMake splits at a semicolon, a backslash or
// a lone bracket, and which Catch2 takes for an option when it begins with a dash.
Violations check_test_names(const std::vector<SourceFile>& files);

}  // namespace firn::architecture
