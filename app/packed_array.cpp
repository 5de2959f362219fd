#include "app/packed_array.h"

#include <fmt/format.h>
#include <zstd.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>

#include "app/arrays.h"
#include "app/files.h"

namespace firn::app {
namespace {

// Snow in motion is noise to a compressor: more effort costs time and gains next to nothing.
constexpr int compression_level = 1;

// A texel of four bytes is one whole number; all else as in app/arrays.h.
std::string header_of(const graph::Plan& plan, const graph::PlannedBuffer& buffer) {
  if (buffer.type != graph::ElementType::rgba8) return scene::npy_header(array_kind(buffer.type), array_shape(plan, buffer));
  return scene::npy_header(scene::NpyKind::uint32,
                           {static_cast<std::uint64_t>(buffer.height), static_cast<std::uint64_t>(buffer.width)});
}

std::uint64_t count_no_numbers(const graph::PlannedBuffer& buffer, std::span<const std::byte> packed) {
  if (graph::scalar(buffer.type) != graph::Scalar::real) return 0;
  std::uint64_t count = 0;
  for (std::size_t at = 0; at + sizeof(float) <= packed.size(); at += sizeof(float)) {
    float value = 0;
    std::memcpy(&value, packed.data() + at, sizeof(value));
    count += std::isnan(value) ? 1 : 0;
  }
  return count;
}

}  // namespace

PackedArray pack(const graph::Plan& plan, const graph::PlannedBuffer& buffer, std::span<const std::byte> contents) {
  const std::string header = header_of(plan, buffer);
  const std::vector<std::byte> packed = graph::unpadded(buffer.type, contents);
  std::vector<std::byte> plain(header.size() + packed.size());
  std::memcpy(plain.data(), header.data(), header.size());
  if (!packed.empty()) std::memcpy(plain.data() + header.size(), packed.data(), packed.size());
  PackedArray result{std::string(ZSTD_compressBound(plain.size()), '\0'), count_no_numbers(buffer, packed)};
  const std::size_t size = ZSTD_compress(result.file.data(), result.file.size(), plain.data(), plain.size(), compression_level);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(fmt::format("cannot compress: {}", ZSTD_getErrorName(size)));
  result.file.resize(size);
  return result;
}

std::vector<std::byte> unpack(const graph::Plan& plan, const graph::PlannedBuffer& buffer, const std::filesystem::path& file,
                              std::uint64_t& no_numbers) {
  const auto refuse = [&](const std::string& why) { throw std::runtime_error(fmt::format("{}: {}", shown(file), why)); };
  const std::string header = header_of(plan, buffer);
  const std::size_t values = buffer.bytes / graph::stride(buffer.type) * static_cast<std::size_t>(graph::components(buffer.type)) *
                             (buffer.type == graph::ElementType::rgba8 ? 1 : 4);
  const std::size_t whole = header.size() + values;
  const std::string compressed = read_whole(file, ZSTD_compressBound(whole));
  std::vector<std::byte> plain(whole);
  const std::size_t size = ZSTD_decompress(plain.data(), plain.size(), compressed.data(), compressed.size());
  if (ZSTD_isError(size) != 0)
    refuse(fmt::format("is not what Zstandard makes of an array of {} bytes: {}", whole, ZSTD_getErrorName(size)));
  if (size != whole)
    refuse(
        fmt::format("holds {} bytes, where an array of shape {} has {}", size, scene::to_string(array_shape(plan, buffer)), whole));
  if (std::memcmp(plain.data(), header.data(), header.size()) != 0)
    refuse(fmt::format("is no NumPy array of shape {} and type {}", scene::to_string(array_shape(plan, buffer)),
                       scene::to_string(array_kind(buffer.type))));
  const std::span packed = std::span<const std::byte>(plain).subspan(header.size());
  no_numbers = count_no_numbers(buffer, packed);
  return graph::padded(buffer.type, packed);
}

}  // namespace firn::app
