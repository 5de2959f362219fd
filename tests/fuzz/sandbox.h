#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace firn::fuzz {

// A folder of small files that inputs may name: pipelines to include, scenes, stages, meshes, points. Removed at the end. Inputs
// with paths that lead out of it are passed over.
class Sandbox {
 public:
  Sandbox();
  ~Sandbox();
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;

  // Puts `text` at `name` in the folder.
  std::filesystem::path put(const std::string& name, std::string_view text) const;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace firn::fuzz
