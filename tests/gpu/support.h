#pragma once

// What the tests of gpu/ share: kernels from text, and buffers of values.

#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gpu/commands.h"
#include "gpu/device.h"
#include "tests/catch.h"

namespace firn::test {

inline gpu::ShaderSource with_version(const gpu::Device& device, const std::string& text) {
  return {device.version_directive() + "\n" + text, {"generated"}};
}

inline gpu::Program kernel(const gpu::Device& device, const std::string& text, const std::string& label = "kernel") {
  const std::array shaders = {std::pair{gpu::ShaderKind::compute, with_version(device, text)}};
  return gpu::Program(shaders, label);
}

template <typename T>
void fill(gpu::Buffer& buffer, const std::vector<T>& values) {
  buffer.upload(0, std::as_bytes(std::span(values)));
}

template <typename T>
gpu::Buffer buffer_of(const std::vector<T>& values, const std::string& label = "buffer") {
  gpu::Buffer buffer(values.size() * sizeof(T), label);
  fill(buffer, values);
  return buffer;
}

template <typename T>
std::vector<T> contents(const gpu::Buffer& buffer) {
  std::vector<T> values(buffer.bytes() / sizeof(T));
  gpu::memory_barrier(static_cast<std::uint32_t>(gpu::BarrierBit::buffer_update));
  buffer.download(0, std::as_writable_bytes(std::span(values)));
  return values;
}

template <typename T>
std::vector<T> texels(const gpu::Texture& texture) {
  gpu::memory_barrier(static_cast<std::uint32_t>(gpu::BarrierBit::texture_update));
  const std::vector<std::byte> bytes = texture.download();
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

// The text of the exception of type E that `action` throws; fails the test where it throws none.
template <typename E, typename Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const E& error) {
    return error.what();
  }
  FAIL("nothing was thrown");
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  INFO("text: " << text);
  INFO("part: " << part);
  const bool found = text.find(part) != std::string::npos;
  CHECK(found);
  return found;
}

// What the test cases with this tag print in a process of its own, in this environment: drivers read variables once.
inline std::string output_of_own_process(const std::string& environment, const std::string& tag) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command = environment + " '" + self + "' '" + tag + "' 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  REQUIRE(pipe);
  std::string output;
  std::array<char, 256> part;
  while (std::fgets(part.data(), part.size(), pipe.get())) output += part.data();
  return output;
}

// A folder that is gone at the end of the test.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_(std::filesystem::temp_directory_path() / ("firn-test-" + std::to_string(std::random_device{}()))) {
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace firn::test
