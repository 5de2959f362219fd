#include "app/checkpoint_files.h"

#include <fmt/format.h>

#include <cctype>
#include <stdexcept>

#include "app/files.h"
#include "app/sha256.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t hash_digits = 64;
constexpr std::uint64_t longest_list = 1 << 20;

[[noreturn]] void fail(const fs::path& file, const std::string& text) {
  throw std::runtime_error(fmt::format("{}: {}", shown(file), text));
}

std::map<std::string, std::string> read_list(const fs::path& file) {
  const std::string text = read_whole(file, longest_list);
  std::map<std::string, std::string> hashes;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    if (line.size() > hash_digits + 2) hashes[line.substr(hash_digits + 2)] = line.substr(0, hash_digits);
    begin = end + 1;
  }
  // Whatever is not just as it is written has been changed.
  if (hashes.empty() || hash_lines(hashes) != text) fail(file, "is not the list of hashes that was written");
  return hashes;
}

}  // namespace

std::string array_file(const std::string& buffer) {
  std::string name;
  for (const char c : buffer) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || c == '_' || c == '-')
      name += c;
    else
      name += fmt::format("%{:02x}", byte);
  }
  return name + ".npy.zst";
}

std::string hash_lines(const std::map<std::string, std::string>& hashes) {
  std::string text;
  for (const auto& [file, hash] : hashes) text += fmt::format("{}  {}\n", hash, file);
  return text;
}

void verify_files(const fs::path& folder) {
  const std::map<std::string, std::string> hashes = read_list(folder / hash_list);
  if (!hashes.contains(checkpoint_manifest)) fail(folder / hash_list, "does not list manifest.json");
  for (const auto& [file, hash] : hashes) {
    if (file.find('/') != std::string::npos)
      fail(folder / hash_list, fmt::format("lists '{}', which is no file of a checkpoint", shown(file)));
    if (sha256_of(folder / file) != hash) fail(folder / file, "is not as it was written: its SHA-256 is another");
  }
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (const std::string name = entry.path().filename().string(); name != hash_list && !hashes.contains(name))
      fail(entry.path(), "does not belong to this checkpoint");
  if (error) fail(folder, fmt::format("cannot be read: {}", error.message()));
}

}  // namespace firn::app
