#include "graph/host.h"

#include <stdexcept>

namespace firn::graph {
namespace {

// Where the scalars of one element lie in its padded form: consecutive, save mat3, whose columns fill 16 bytes each.
std::size_t padded_offset(ElementType type, int component) {
  const auto c = static_cast<std::size_t>(component);
  return type == ElementType::mat3 ? c / 3 * 16 + c % 3 * 4 : c * 4;
}

template <typename T>
std::vector<T> typed(std::span<const std::byte> bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

}  // namespace

// mat3 is column by column on the device; unpadded it is row by row, as NumPy reads a C-order array [3][3].
static int packed_component(ElementType type, int component) {
  return type == ElementType::mat3 ? component % 3 * 3 + component / 3 : component;
}

std::vector<std::byte> unpadded(ElementType type, std::span<const std::byte> padded_bytes) {
  if (is_texel(type)) return {padded_bytes.begin(), padded_bytes.end()};
  const std::size_t step = stride(type);
  const std::size_t count = padded_bytes.size() / step;
  const int parts = components(type);
  std::vector<std::byte> packed(count * static_cast<std::size_t>(parts) * 4);
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < parts; ++c)
      std::memcpy(&packed[(i * static_cast<std::size_t>(parts) + static_cast<std::size_t>(packed_component(type, c))) * 4],
                  &padded_bytes[i * step + padded_offset(type, c)], 4);
  return packed;
}

std::vector<std::byte> padded(ElementType type, std::span<const std::byte> packed) {
  if (is_texel(type)) return {packed.begin(), packed.end()};
  const std::size_t step = stride(type);
  const int parts = components(type);
  const std::size_t count = packed.size() / (static_cast<std::size_t>(parts) * 4);
  std::vector<std::byte> bytes(count * step);
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < parts; ++c)
      std::memcpy(&bytes[i * step + padded_offset(type, c)],
                  &packed[(i * static_cast<std::size_t>(parts) + static_cast<std::size_t>(packed_component(type, c))) * 4], 4);
  return bytes;
}

std::vector<float> HostContext::read_floats(std::string_view port) { return typed<float>(unpadded(view(port).type, read(port))); }

std::vector<std::int32_t> HostContext::read_integers(std::string_view port) {
  return typed<std::int32_t>(unpadded(view(port).type, read(port)));
}

void HostContext::write_floats(std::string_view port, std::span<const float> values) {
  write(port, padded(view(port).type, std::as_bytes(values)));
}

void HostContext::write_integers(std::string_view port, std::span<const std::int32_t> values) {
  write(port, padded(view(port).type, std::as_bytes(values)));
}

}  // namespace firn::graph
