#pragma once

// Any bytes at all as a file of Firn's, looked at as `firn check` looks at it, without a device. For the fuzzers and for the
// replay of what they found.

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

// The input as a pipeline, a scene, a stage that is a file. Input errors are the answer that is hoped for; anything else that is
// thrown, and a plan with a memory hazard, is a finding and leaves the function.
void check_pipeline(const Sandbox& sandbox, std::string_view text);
void check_scene(const Sandbox& sandbox, std::string_view text);
void check_stage(const Sandbox& sandbox, std::string_view text);

}  // namespace firn::fuzz
