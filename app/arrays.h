#pragma once

// Buffers as arrays in files: packed scalars in C order, without the padding they have on the device.
//
// Shape: that of the domain (particles: N; nodes: nz, ny, nx; cells: rows along z, columns along x), then the components (vec3: 3;
// mat3: 3, 3). Buffers of stored blocks of the grid are written as the whole grid where that has no more than 2^28 nodes, else as
// blocks: slots, 4, 4, 4.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "graph/execution/execution.h"
#include "scene/npy.h"

namespace firn::app {

// The last axes of an element type: none, {3}, {3, 3}.
scene::NpyShape component_shape(graph::ElementType type);
scene::NpyShape array_shape(const graph::Plan& plan, const graph::PlannedBuffer& buffer);
scene::NpyKind array_kind(graph::ElementType type);

// Numbers that the type can hold, as its scalars.
std::vector<std::byte> packed_values(graph::ElementType type, const std::vector<double>& values);

// The contents of a buffer, and the reverse. Throw std::out_of_range for an unknown name, std::logic_error for a wrong number of
// values.
std::vector<std::byte> read_buffer(const execution::Execution& execution, const std::string& buffer);
void fill_buffer(execution::Execution& execution, const std::string& buffer, std::span<const std::byte> packed);

inline constexpr std::uint64_t most_dumped_nodes = std::uint64_t{1} << 28;
struct Array {
  std::string domain;
  scene::NpyShape shape;
  std::vector<std::byte> packed;
};
Array read_array(const execution::Execution& execution, const std::string& buffer);
// Writes it to an .npy file.
void write_array(const execution::Execution& execution, const std::string& buffer, const std::string& file);

}  // namespace firn::app
