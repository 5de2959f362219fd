#pragma once

// VTK's XML files: .vtp (points and surfaces) and .vti (values on a regular grid). Data lie inline, as base64 of zlib blocks, which
// every ParaView reads.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace firn::stages::vtk {

struct Array {
  std::string name, type;  // "Float32", "Int32"
  int components = 1;
  std::string text;  // encoded
};
// `level`: of zlib, 0 (fast, large) to 9.
Array array(std::string name, int components, std::span<const float> values, int level);
Array array(std::string name, int components, std::span<const std::int32_t> values, int level);

struct Cells {
  std::string kind;  // "Verts", "Polys"
  std::size_t count = 0;
  Array connectivity, offsets;
};
Cells one_per_point(std::size_t points, int level);
Cells triangles(std::span<const std::array<int, 3>> corners, int level);

struct PolyData {
  std::size_t points_count = 0;
  Array points;
  Cells cells;
  std::vector<Array> point_data, cell_data;
};
std::string to_text(const PolyData& data, double time);

struct Image {
  std::array<double, 3> origin{}, spacing{};
  std::array<int, 3> first{}, last{};  // indices of its nodes, both included; node i lies at origin + i spacing
  std::vector<Array> point_data;       // x runs fastest
};
std::string to_text(const Image& image, double time);

}  // namespace firn::stages::vtk
