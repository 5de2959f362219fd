#pragma once

// The built program as a child process.

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace firn::test {

struct Outcome {
  int status = -1;  // exit status; -1: ended by a signal
  std::string out, err;
  double seconds = 0;
  long peak_kilobytes = 0;  // resident memory
};

using Words = std::vector<std::string>;
using Variables = std::vector<std::pair<std::string, std::string>>;

// A new folder below the system's temporary one, removed with everything in it at the end.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const;  // the file's path

 private:
  std::filesystem::path path_;
};

// Runs firn with `words`, waits for it. `variables` are set beside those of this process.
Outcome run_firn(const Words& words, const Variables& variables = {});

// As above, but sends `signal` as soon as stderr contains `cue`.
Outcome run_firn_signalled(const Words& words, const std::string& cue, int signal);

// As above, but kills it (SIGKILL) after so many seconds, unless it has ended by then.
Outcome run_firn_killed(const Words& words, double seconds);

std::string read_file(const std::filesystem::path& file);

}  // namespace firn::test
