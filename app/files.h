#pragma once

// Files that must survive: written as a whole or not at all; and files of others, read without trusting them.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

namespace firn::app {

// A path for people: bytes that are no UTF-8 as \xNN, control characters too.
std::string shown(const std::filesystem::path& path);

// Throws std::runtime_error, naming it, where it is no regular file or cannot be opened. Never waits, as for a pipe.
std::ifstream open_regular(const std::filesystem::path& file);

// All of it. Throws std::runtime_error besides where it is larger than `most` bytes.
std::string read_whole(const std::filesystem::path& file, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

// Throws std::runtime_error naming the file, as where the disk is full.
void write_file(const std::filesystem::path& file, std::string_view text);
// All files of the disk that a folder lies on, and their names, are on the disk when this returns: one wait for many files.
void make_all_durable(const std::filesystem::path& folder);
// The names in one folder are.
void make_durable(const std::filesystem::path& folder);

// Beside it under another name, then renamed: `file` is whole, or as it was.
void replace_file(const std::filesystem::path& file, std::string_view text);

class Descriptor;  // an open file

// A file that grows line by line: each is there as a whole, or not at all.
class LineFile {
 public:
  explicit LineFile(const std::filesystem::path& file);  // goes on after what there is
  ~LineFile();
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  // With its line break. Throws std::runtime_error naming the file, as where the disk is full.
  void add(std::string_view line);

 private:
  std::unique_ptr<const Descriptor> file_;
};

// "2026-03-01T12:00:00Z"
std::string now_in_utc();

}  // namespace firn::app
