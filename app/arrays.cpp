#include "app/arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "stages/mpm_ports.h"

namespace firn::app {
namespace {

const graph::PlannedBuffer& planned(const execution::Execution& execution, const std::string& name) {
  const int index = execution.plan().buffer(name);
  if (index < 0) throw std::out_of_range(fmt::format("no buffer '{}'", name));
  return execution.plan().buffers[static_cast<std::size_t>(index)];
}

template <typename T>
void write_as(const std::string& file, const scene::NpyShape& shape, std::span<const std::byte> bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  scene::write_npy(file, shape, std::span<const T>(values));
}

template <typename T>
std::vector<std::byte> packed_as(const std::vector<double>& values) {
  std::vector<T> converted;
  converted.reserve(values.size());
  for (const double value : values) converted.push_back(static_cast<T>(value));
  const auto bytes = std::as_bytes(std::span(converted));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

scene::NpyShape component_shape(graph::ElementType type) {
  if (type == graph::ElementType::mat3) return {3, 3};
  const int parts = graph::components(type);
  return parts > 1 ? scene::NpyShape{static_cast<std::uint64_t>(parts)} : scene::NpyShape{};
}

scene::NpyShape array_shape(const graph::Plan& plan, const graph::PlannedBuffer& buffer) {
  scene::NpyShape shape;
  if (const auto domain = plan.environment.domains.find(buffer.domain); domain != plan.environment.domains.end())
    shape = domain->second.shape;
  if (shape.empty()) shape = {buffer.count};
  const scene::NpyShape parts = component_shape(buffer.type);
  shape.insert(shape.end(), parts.begin(), parts.end());
  return shape;
}

scene::NpyKind array_kind(graph::ElementType type) {
  switch (graph::scalar(type)) {
    case graph::Scalar::integer:
      return scene::NpyKind::int32;
    case graph::Scalar::natural:
      return scene::NpyKind::uint32;
    default:
      return scene::NpyKind::float32;
  }
}

std::vector<std::byte> packed_values(graph::ElementType type, const std::vector<double>& values) {
  switch (array_kind(type)) {
    case scene::NpyKind::int32:
      return packed_as<std::int32_t>(values);
    case scene::NpyKind::uint32:
      return packed_as<std::uint32_t>(values);
    default:
      return packed_as<float>(values);
  }
}

std::vector<std::byte> read_buffer(const execution::Execution& execution, const std::string& buffer) {
  return graph::unpadded(planned(execution, buffer).type, execution.read(buffer));
}

void fill_buffer(execution::Execution& execution, const std::string& buffer, std::span<const std::byte> packed) {
  const graph::PlannedBuffer& target = planned(execution, buffer);
  const std::vector<std::byte> bytes = graph::padded(target.type, packed);
  if (bytes.size() != target.bytes) throw std::logic_error("wrong number of values for " + buffer);
  execution.write(buffer, bytes);
}

namespace {

std::vector<std::uint32_t> read_naturals(const execution::Execution& execution, const std::string& buffer) {
  const std::vector<std::byte> bytes = execution.read(buffer);
  std::vector<std::uint32_t> values(bytes.size() / sizeof(std::uint32_t));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

// Values of stored blocks, laid out as the whole grid [nz, ny, nx]; zero where nothing is stored.
std::vector<std::byte> whole_grid(const execution::Execution& execution, const scene::NpyShape& nodes,
                                  const std::vector<std::byte>& stored, std::size_t element) {
  const std::uint64_t nx = nodes.at(2), ny = nodes.at(1), nz = nodes.at(0), bx = nx / 4 + 1, by = ny / 4 + 1;
  std::vector<std::byte> grid(nx * ny * nz * element);
  const std::vector<std::uint32_t> blocks = read_naturals(execution, "active_blocks");
  const std::uint64_t count = std::min<std::uint64_t>(read_naturals(execution, "active_block_count").at(0), blocks.size());
  for (std::uint64_t row = 0; row < 16 * count; ++row) {  // of four nodes
    const std::uint64_t block = blocks[row / 16];
    const std::uint64_t x = 4 * (block % bx), y = 4 * (block / bx % by) + row % 4, z = 4 * (block / (bx * by)) + row / 4 % 4;
    if (x >= nx || y >= ny || z >= nz) continue;
    std::memcpy(&grid[(x + nx * (y + ny * z)) * element], &stored[4 * row * element], std::min<std::uint64_t>(4, nx - x) * element);
  }
  return grid;
}

}  // namespace

Array read_array(const execution::Execution& execution, const std::string& buffer) {
  const graph::PlannedBuffer& source = planned(execution, buffer);
  Array array{source.domain, array_shape(execution.plan(), source), read_buffer(execution, buffer)};
  if (source.domain != stages::mpm::block_nodes) return array;
  const graph::DomainSize& nodes = execution.plan().environment.domains.at(stages::mpm::all_nodes);
  const bool whole = nodes.count <= most_dumped_nodes;
  array.shape.erase(array.shape.begin());
  if (whole) {
    array.domain = stages::mpm::all_nodes;
    array.packed = whole_grid(execution, nodes.shape, array.packed, array.packed.size() / source.count);
    array.shape.insert(array.shape.begin(), nodes.shape.begin(), nodes.shape.end());
  } else {
    array.shape.insert(array.shape.begin(), {source.count / 64, 4, 4, 4});
  }
  return array;
}

void write_array(const execution::Execution& execution, const std::string& buffer, const std::string& file) {
  const graph::PlannedBuffer& source = planned(execution, buffer);
  const auto [domain, shape, values] = read_array(execution, buffer);
  switch (array_kind(source.type)) {
    case scene::NpyKind::int32:
      return write_as<std::int32_t>(file, shape, values);
    case scene::NpyKind::uint32:
      return write_as<std::uint32_t>(file, shape, values);
    default:
      return write_as<float>(file, shape, values);
  }
}

}  // namespace firn::app
