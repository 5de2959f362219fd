#pragma once

// Files of results: whole or not there, one per frame, and lists of them with their times.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace firn::stages {

// `write` makes the file it is given, which lies beside `file` and is then renamed. However that ends, no half file is left.
// Throws std::runtime_error naming `file`.
void write_beside(const std::filesystem::path& file, const std::function<void(const std::filesystem::path& part)>& write);
// The same, with the file open; it is closed for it, and that the disk runs full as late as then is told, too.
void write_stream_beside(const std::filesystem::path& file, const std::function<void(std::FILE* stream)>& write);
void write_file(const std::filesystem::path& file, std::string_view bytes);

[[noreturn]] void fail_to_write(const std::filesystem::path& file, const std::string& why);

// One kind of file in the folder of exports: particles_0000.vtp, particles_0001.vtp, ... For files of VTK's XML kinds also
// particles.vtp.series and particles.pvd, which list them with their times. Files of the same names and of later frames that an
// earlier run left are removed; a run that goes on from a later frame keeps those before it, with their times.
class Series {
 public:
  Series(std::filesystem::path folder, std::string stem, std::string extension);

  // The name for this frame, in a folder that is there.
  std::filesystem::path file(std::uint64_t frame, const std::string& suffix = "");
  // After the file is written.
  void add(std::uint64_t frame, double time);

 private:
  void begin(std::uint64_t frame);
  void read_times(std::uint64_t before);

  std::filesystem::path folder_;
  std::string stem_, extension_;
  bool begun_ = false;
  std::map<std::uint64_t, double> times_;  // s, by frame
};

}  // namespace firn::stages
