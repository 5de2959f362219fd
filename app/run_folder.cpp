#include "app/run_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>

#include "app/files.h"
#include "config/diagnostics.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* lock_file = ".lock";

[[noreturn]] void refuse(const fs::path& path, const std::string& text) {
  config::Diagnostics diagnostics;
  diagnostics.error({shown(path), 0, 0}, text);
  throw config::InputError(diagnostics);
}

// -1: there is no such file.
int lock(const fs::path& folder, int flags) {
  const int descriptor = open((folder / lock_file).c_str(), O_RDWR | O_CLOEXEC | flags, 0666);
  if (descriptor < 0) {
    if (errno == ENOENT && (flags & O_CREAT) == 0) return -1;
    throw std::runtime_error(fmt::format("cannot write to the folder {}: {}", shown(folder), std::strerror(errno)));
  }
  if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  close(descriptor);
  refuse(folder, "another process is running in this folder; --out names another");
}

std::optional<std::uint64_t> number_of_frame(const std::string& name) {
  constexpr std::string_view begin = "frame_";
  std::uint64_t number = 0;
  if (!name.starts_with(begin)) return {};
  const auto [end, error] = std::from_chars(name.data() + begin.size(), name.data() + name.size(), number);
  const std::string_view rest(end, static_cast<std::size_t>(name.data() + name.size() - end));
  if (error != std::errc() || (rest != ".png" && rest != ".png.part")) return {};
  return number;
}

constexpr std::array written_by_runs{run_manifest,  "manifest.json.part", "log.jsonl",  "metrics.csv",
                                     "video.mp4",   "video.part.mp4",     "ffmpeg.log", "encoders.txt",
                                     "video.parts", "checkpoints",        "export"};

// Of an earlier run, or of anybody's: what a run would write over.
bool holds_such(const fs::path& folder) {
  return fs::exists(folder / "frames") ||
         std::ranges::any_of(written_by_runs, [&](const char* name) { return fs::exists(fs::symlink_status(folder / name)); });
}

void remove_run(const fs::path& run) {
  for (const char* name : written_by_runs) fs::remove_all(run / name);
  remove_frames_from(run, 0);
}

// The first free name of those with a number.
fs::path free_name(const fs::path& path) {
  for (int number = 1;; ++number) {
    fs::path name = path;
    name += fmt::format("-{}", number);
    if (!fs::exists(fs::symlink_status(name))) return name;
  }
}

fs::path move_away(const fs::path& run) {
  if (fs::equivalent(run, fs::current_path()))
    refuse(run,
           "this is the working folder and holds an earlier run, or files with names of a run's; --force replaces these, --out "
           "names another folder");
  const fs::path whole = fs::absolute(run / "").lexically_normal().parent_path();
  const fs::path name = free_name(whole);
  std::error_code error;
  fs::rename(whole, name, error);
  if (error)
    refuse(run,
           fmt::format("holds an earlier run, which cannot be moved to {}: {}; --force replaces it, --out names another folder",
                       shown(name), error.message()));
  return run.parent_path() / name.filename();
}

}  // namespace

RunFolder::RunFolder(const fs::path& path, Claim claim) : path_((path / "").parent_path()) {
  try {
    if (claim == Claim::fresh ? holds_such(path_) : claim == Claim::replace && fs::exists(path_ / run_manifest)) {
      const int in_use = lock(path_, 0);
      if (in_use >= 0) close(in_use);
      if (claim == Claim::fresh)
        moved_ = move_away(path_);
      else
        remove_run(path_);
    }
    fs::create_directories(path_);
  } catch (const fs::filesystem_error& error) {
    throw std::runtime_error(fmt::format("cannot make the folder {}: {}", path_.string(), error.code().message()));
  }
  lock_ = lock(path_, O_CREAT);
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  fs::remove(path_ / lock_file, ignored);
  close(lock_);
}

void remove_frames_from(const fs::path& run, std::uint64_t frame) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(run / "frames", error)) {
    const std::string name = entry.path().filename().string();
    if (const auto number = number_of_frame(name); number && (*number >= frame || name.ends_with(".part")))
      fs::remove(entry.path());
  }
}

}  // namespace firn::app
