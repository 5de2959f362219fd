#pragma once

// Readers of exported files, written from the formats' descriptions, apart from what writes them.

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace firn::test {

std::string bytes_of(const std::filesystem::path& file);

// VTK XML: attributes of the elements we look at, and arrays by name as doubles.
struct VtkFile {
  std::string text;
  std::map<std::string, std::vector<double>> arrays;
  std::map<std::string, int> components;
  [[nodiscard]] std::string attribute(const std::string& element, const std::string& name) const;  // of the first such element
};
VtkFile read_vtk(const std::filesystem::path& file);

struct PlyFile {
  std::map<std::string, std::vector<double>> columns;  // of vertices
  std::vector<std::array<int, 3>> faces;
};
PlyFile read_ply(const std::filesystem::path& file);

struct ObjFile {
  std::vector<std::string> objects;
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 3>> faces;  // from 0
};
ObjFile read_obj(const std::filesystem::path& file);

struct NpyFile {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};
NpyFile read_npy_file(const std::filesystem::path& file);

// Of a triangle mesh: its volume, and whether every edge is used once in either direction.
double volume_of(const std::vector<std::array<double, 3>>& points, const std::vector<std::array<int, 3>>& faces);
bool is_watertight(const std::vector<std::array<int, 3>>& faces);

}  // namespace firn::test
