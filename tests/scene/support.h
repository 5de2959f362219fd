#pragma once

// What the tests of scenes share: a folder that goes away, and scenes read from text.

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>

#include "config/diagnostics.h"
#include "config/node.h"
#include "scene/scene.h"
#include "tests/catch.h"

namespace firn::test {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    static std::atomic<int> number{0};
    path_ = std::filesystem::temp_directory_path() /
            ("firn-scene-" + std::to_string(std::random_device{}()) + "-" + std::to_string(number++));
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  void write(const std::string& name, const std::string& bytes) const { std::ofstream(path_ / name, std::ios::binary) << bytes; }

 private:
  std::filesystem::path path_;
};

struct ReadResult {
  scene::Scene scene;
  config::Diagnostics diagnostics;
  [[nodiscard]] std::string text() const {
    std::string lines;
    for (const config::Diagnostic& each : diagnostics.all()) lines += config::to_string(each) + "\n";
    return lines;
  }
};

// Reads `text` as if it stood in the file `scene.yaml` of `folder`.
inline ReadResult read_text(const std::string& text, const std::filesystem::path& file = "scene.yaml") {
  ReadResult result;
  const config::Node root = config::parse(text, file.string(), result.diagnostics);
  result.scene = scene::read_scene(root, result.diagnostics);
  return result;
}

// A scene that must be free of errors and warnings.
inline scene::Scene good_scene(const std::string& text, const std::filesystem::path& file = "scene.yaml") {
  ReadResult result = read_text(text, file);
  INFO(result.text());
  REQUIRE(result.diagnostics.all().empty());
  return result.scene;
}

// Line and column, from 1, of the only occurrence of `marker` in `text`.
inline std::array<int, 2> place_of(const std::string& text, const std::string& marker) {
  const std::size_t at = text.find(marker);
  REQUIRE(at != std::string::npos);
  REQUIRE(text.find(marker, at + 1) == std::string::npos);
  const auto line = static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')) + 1;
  const std::size_t line_begin = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;  // npos + 1 is 0
  return {line, static_cast<int>(at - line_begin) + 1};
}

}  // namespace firn::test
