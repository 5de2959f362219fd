#include "gpu/program_cache.h"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <random>
#include <span>
#include <stdexcept>

namespace firn::gpu {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view extension = ".program";
constexpr std::string_view unfinished = ".unfinished";
constexpr std::size_t digits = 64;  // of a digest

// The file: this line, a digest of all that follows, the key, the format, the binary.
constexpr std::string_view first_line = "firn program 1\n";
constexpr std::size_t head_bytes = first_line.size() + 2 * digits + sizeof(std::uint32_t);

std::string_view as_text(std::span<const std::byte> bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

std::string contents(const std::string& key, const ProgramCache::Entry& entry) {
  std::string body = key;
  body.append(reinterpret_cast<const char*>(&entry.format), sizeof(entry.format));
  body += as_text(entry.binary);
  return std::string(first_line) + digest(body) + body;
}

// Empty where the text is a whole entry of `key`, else what is wrong.
std::string fault(std::string_view text, const std::string& key) {
  if (!text.starts_with(first_line)) return "it is no program of this version's";
  if (text.size() <= head_bytes) return "it is cut off";
  text.remove_prefix(first_line.size());
  const std::string_view told = text.substr(0, digits), body = text.substr(digits);
  if (digest(body) != told) return "it is damaged or cut off";
  if (!body.starts_with(key)) return "it is another program's";
  return "";
}

// Ours by its name: nothing else in the folder is touched.
bool is_ours(const fs::path& path, std::string_view end) {
  const std::string name = path.filename().string();
  return name.size() > digits && name.ends_with(end) &&
         std::all_of(name.begin(), name.begin() + digits, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

struct Found {
  fs::path path;
  std::uint64_t bytes = 0;
  fs::file_time_type used;
};

// Files may come and go while the folder is read.
std::vector<Found> list(const fs::path& folder, std::string_view end) {
  std::vector<Found> found;
  std::error_code error;
  for (fs::directory_iterator file(folder, error); !error && file != fs::directory_iterator(); file.increment(error)) {
    if (!is_ours(file->path(), end)) continue;
    std::error_code gone;
    const std::uint64_t bytes = file->file_size(gone);
    if (gone) continue;
    const fs::file_time_type used = file->last_write_time(gone);
    if (!gone) found.push_back({file->path(), bytes, used});
  }
  return found;
}

}  // namespace

std::string digest(std::string_view data) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> value{};
  unsigned int length = 0;
  if (EVP_Digest(data.data(), data.size(), value.data(), &length, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("the library libcrypto cannot compute SHA-256 here");
  std::string text;
  for (unsigned int i = 0; i < length; ++i) text += fmt::format("{:02x}", value[i]);
  return text;
}

ProgramCache::ProgramCache(fs::path folder, Tell tell, std::uint64_t most_bytes)
    : folder_(std::move(folder)), tell_(std::move(tell)), most_bytes_(most_bytes) {}

fs::path ProgramCache::file(const std::string& key) const { return folder_ / (key + std::string(extension)); }

void ProgramCache::tell(const std::string& text) const {
  if (tell_) tell_(text);
}

std::optional<ProgramCache::Entry> ProgramCache::find(const std::string& key) const {
  const fs::path path = file(key);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream.is_open() && (errno == ENOENT || errno == ENOTDIR)) return std::nullopt;
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad() || !stream.is_open()) {
    tell(fmt::format("{} cannot be read", path.string()));
    return std::nullopt;
  }
  if (const std::string wrong = fault(text, key); !wrong.empty()) {
    remove(key, wrong);
    return std::nullopt;
  }
  std::error_code error;
  fs::last_write_time(path, fs::file_time_type::clock::now(), error);  // so that trim() sees the use; a read-only folder does too
  Entry entry;
  std::memcpy(&entry.format, text.data() + head_bytes - sizeof(entry.format), sizeof(entry.format));
  const auto binary = std::as_bytes(std::span(text)).subspan(head_bytes);
  entry.binary.assign(binary.begin(), binary.end());
  return entry;
}

// Written beside and renamed: another process sees the whole entry or none.
void ProgramCache::store(const std::string& key, const Entry& entry) const {
  // Machines may share the folder, and a process may have forked.
  static const std::string program = fmt::format("{:08x}{:08x}", std::random_device()(), std::random_device()());
  static std::atomic<unsigned> number{0};
  const fs::path target = file(key);
  const fs::path beside = folder_ / fmt::format("{}.{}.{}.{}{}", key, program, getpid(), number++, unfinished);
  std::error_code error;
  if (fs::create_directories(folder_, error); error) {
    tell(fmt::format("the folder {} cannot be made: {}", folder_.string(), error.message()));
    return;
  }
  const std::string text = contents(key, entry);
  std::ofstream stream(beside, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (stream.good()) fs::rename(beside, target, error);
  if (!stream.good() || error) {
    tell(fmt::format("{} cannot be written{}{}", target.string(), error ? ": " : "", error ? error.message() : ""));
    fs::remove(beside, error);
  }
}

void ProgramCache::remove(const std::string& key, const std::string& why) const {
  const fs::path path = file(key);
  tell(fmt::format("{} is of no use and removed: {}", path.string(), why));
  std::error_code error;
  fs::remove(path, error);
}

void ProgramCache::trim() const {
  std::error_code error;
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (const Found& left : list(folder_, unfinished))
    if (left.used < long_ago) fs::remove(left.path, error);
  std::vector<Found> entries = list(folder_, extension);
  std::uint64_t bytes = 0;
  for (const Found& entry : entries) bytes += entry.bytes;
  if (bytes <= most_bytes_) return;
  std::sort(entries.begin(), entries.end(), [](const Found& a, const Found& b) { return a.used < b.used; });
  const std::uint64_t kept = most_bytes_ / 4 * 3;
  std::size_t removed = 0;
  for (; removed < entries.size() && bytes > kept; ++removed) {
    fs::remove(entries[removed].path, error);
    bytes -= entries[removed].bytes;
  }
  tell(
      fmt::format("{} of {} programs were removed from {}, those not used for longest", removed, entries.size(), folder_.string()));
}

ProgramCache::Size ProgramCache::size() const {
  Size size;
  for (const Found& entry : list(folder_, extension)) {
    ++size.entries;
    size.bytes += entry.bytes;
  }
  return size;
}

}  // namespace firn::gpu
