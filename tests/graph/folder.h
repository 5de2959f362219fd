#pragma once

// A folder for the files of one test, and diagnostics as a user sees them with that folder as the current one.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "config/diagnostics.h"

namespace firn::test {

class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() / ("firn_graph_" + std::to_string(getpid()) + "_" + std::to_string(next_++))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path write(const std::string& name, std::string_view text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  // The text with paths below the folder made relative.
  [[nodiscard]] std::string shortened(std::string text) const {
    const std::string prefix = path_.string() + "/";
    for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) text.erase(at, prefix.size());
    return text;
  }

  [[nodiscard]] std::vector<std::string> texts(const config::Diagnostics& diagnostics) const {
    std::vector<std::string> lines;
    for (const config::Diagnostic& diagnostic : diagnostics.all()) lines.push_back(shortened(to_string(diagnostic)));
    return lines;
  }

 private:
  static inline int next_ = 0;
  std::filesystem::path path_;
};

using Lines = std::vector<std::string>;

}  // namespace firn::test
