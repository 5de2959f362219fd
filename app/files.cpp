#include "app/files.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <system_error>

namespace firn::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& text) {
  throw std::runtime_error(fmt::format("{}: {}", shown(path), text));
}

// The length of the UTF-8 character that `text` begins with; 0: it begins with none.
std::size_t character(std::string_view text) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const std::size_t length = byte(0) < 0x80 ? 1 : byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : byte(0) >= 0xc2 ? 2 : 0;
  if (length == 0 || length > text.size() || byte(0) > 0xf4) return 0;
  for (std::size_t at = 1; at < length; ++at)
    if ((byte(at) & 0xc0) != 0x80) return 0;
  return length;
}

}  // namespace

class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : path_(path), number_(open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (number_ < 0) fail(path, fmt::format("cannot be opened: {}", std::strerror(errno)));
  }
  ~Descriptor() { close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t written = ::write(number_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path_, fmt::format("cannot be written: {}", std::strerror(errno)));
      text.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  // All of it, at the end of the file, or nothing.
  void append(std::string_view text) const {
    const off_t before = lseek(number_, 0, SEEK_END);
    try {
      write(text);
    } catch (...) {
      if (before < 0 || ftruncate(number_, before) != 0) fail(path_, "ends in half a line, as it cannot be cut off either");
      throw;
    }
  }
  void sync() const {
    // Some file systems have no fsync for folders.
    if (fsync(number_) != 0 && errno != EINVAL) fail(path_, fmt::format("cannot be written: {}", std::strerror(errno)));
  }
  void sync_all() const {
    if (syncfs(number_) != 0) fail(path_, fmt::format("cannot be written: {}", std::strerror(errno)));
  }

 private:
  fs::path path_;
  int number_;
};

std::string shown(const fs::path& path) {
  const std::string text = path.string();
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character(std::string_view(text).substr(at));
    const auto byte = static_cast<unsigned char>(text[at]);
    if (length == 0 || byte < 0x20 || byte == 0x7f) {
      result += fmt::format("\\x{:02x}", byte);
      ++at;
    } else {
      result += text.substr(at, length);
      at += length;
    }
  }
  return result;
}

std::ifstream open_regular(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) fail(file, "this file is missing");
  if (error) fail(file, fmt::format("cannot be read: {}", error.message()));
  if (!fs::is_regular_file(status)) fail(file, "this is no file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, "cannot be opened for reading");
  return stream;
}

std::string read_whole(const fs::path& file, std::uint64_t most) {
  std::ifstream stream = open_regular(file);
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  if (error) fail(file, fmt::format("cannot be read: {}", error.message()));
  if (size > most) fail(file, fmt::format("has {} bytes, where {} are the most that can be right", size, most));
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uint64_t>(stream.gcount()) != size) fail(file, "cannot be read to its end");
  return text;
}

void write_file(const fs::path& file, std::string_view text) { Descriptor(file, O_WRONLY | O_CREAT | O_TRUNC).write(text); }

void make_all_durable(const fs::path& folder) { Descriptor(folder, O_RDONLY | O_DIRECTORY).sync_all(); }

void make_durable(const fs::path& folder) { Descriptor(folder, O_RDONLY | O_DIRECTORY).sync(); }

void replace_file(const fs::path& file, std::string_view text) {
  fs::path part = file;
  part += ".part";
  std::error_code error, ignored;
  try {
    const Descriptor descriptor(part, O_WRONLY | O_CREAT | O_TRUNC);
    descriptor.write(text);
    descriptor.sync();
  } catch (...) {
    fs::remove(part, ignored);
    throw;
  }
  fs::rename(part, file, error);
  if (!error) return;
  fs::remove(part, ignored);
  fail(file, fmt::format("cannot be written: {}", error.message()));
}

LineFile::LineFile(const fs::path& file) : file_(std::make_unique<const Descriptor>(file, O_WRONLY | O_CREAT)) {}
LineFile::~LineFile() = default;
void LineFile::add(std::string_view line) { file_->append(line); }

std::string now_in_utc() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

}  // namespace firn::app
