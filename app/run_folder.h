#pragma once

// The folder of one run (docs/runs.md). One run at a time writes to it, and none writes over another.

#include <filesystem>
#include <string>

namespace firn::app {

enum class Claim {
  fresh,    // an earlier run in it moves to a name of its own beside it
  replace,  // an earlier run in it is removed: what Firn writes, nothing else
  resume,   // it goes on
};

// Holds a lock in the folder while it lives; a process that dies loses it.
class RunFolder {
 public:
  // Throws config::InputError where another process is running there, or where the folder cannot be moved away because somebody
  // works in it; std::runtime_error where it cannot be made.
  RunFolder(const std::filesystem::path& path, Claim claim);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  // Where the earlier run is now; empty: there was none.
  [[nodiscard]] const std::filesystem::path& moved() const { return moved_; }

 private:
  std::filesystem::path path_, moved_;
  int lock_ = -1;
};

inline constexpr const char* run_manifest = "manifest.json";

// Pictures of frames from this one on, which a run that died may have left, and halves of files.
void remove_frames_from(const std::filesystem::path& run, std::uint64_t frame);

}  // namespace firn::app
