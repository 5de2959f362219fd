#pragma once

// Linked programs on disk, as the driver hands them out, so that the next start need not compile them. Any number of processes may
// use one folder at once. Nothing here fails: what cannot be read or written is told to `tell`, and the program is compiled.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace firn::gpu {

class ProgramCache {
 public:
  static constexpr std::uint64_t usual_bytes = std::uint64_t{64} << 20;  // some thousand programs of Mesa, hundreds of others

  using Tell = std::function<void(const std::string&)>;  // from any thread
  // The folder is made when the first entry is stored; it holds `most_bytes` at most once trim() has returned.
  explicit ProgramCache(std::filesystem::path folder, Tell tell = {}, std::uint64_t most_bytes = usual_bytes);

  struct Entry {
    std::uint32_t format = 0;  // the driver's
    std::vector<std::byte> binary;
  };
  // `key`: 64 hexadecimal digits. An entry that is cut off, damaged or of another key is none, and is removed.
  [[nodiscard]] std::optional<Entry> find(const std::string& key) const;
  void store(const std::string& key, const Entry& entry) const;
  void remove(const std::string& key, const std::string& why) const;

  // Removes entries that were not used for longest, down to three quarters, once there is more than the cache may hold; and what
  // processes left that died while they stored.
  void trim() const;

  struct Size {
    std::size_t entries = 0;
    std::uint64_t bytes = 0;
  };
  [[nodiscard]] Size size() const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  [[nodiscard]] std::filesystem::path file(const std::string& key) const;
  void tell(const std::string& text) const;

  std::filesystem::path folder_;
  Tell tell_;
  std::uint64_t most_bytes_;
};

// SHA-256 as 64 hexadecimal digits.
std::string digest(std::string_view data);

}  // namespace firn::gpu
