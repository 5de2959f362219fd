#include "stages/mesh_files.h"

#include <fmt/format.h>

#include <cstring>
#include <iterator>

namespace firn::stages {
namespace {

template <typename T>
void append(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

constexpr const char* ply_start = "ply\nformat binary_little_endian 1.0\ncomment Firn; metres\n";

}  // namespace

std::string ply_of(const scene::TriangleMesh& mesh) {
  std::string bytes = fmt::format(
      "{}element vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      ply_start, mesh.points.size(), mesh.triangles.size());
  bytes.reserve(bytes.size() + mesh.points.size() * 12 + mesh.triangles.size() * 13);
  for (const scene::Vector3d& point : mesh.points)
    for (const double part : point) append(bytes, static_cast<float>(part));
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    bytes += '\3';
    for (const int corner : triangle) append(bytes, corner);
  }
  return bytes;
}

std::string obj_of(std::span<const NamedMesh> objects) {
  std::string text = "# Firn; metres\n";
  std::size_t first = 1;  // corners are counted through the whole file
  for (const NamedMesh& object : objects) {
    std::string name = object.name;
    for (char& c : name)
      if (static_cast<unsigned char>(c) <= ' ') c = '_';
    fmt::format_to(std::back_inserter(text), "o {}\n", name);
    for (const scene::Vector3d& p : object.mesh.points)
      fmt::format_to(std::back_inserter(text), "v {:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
    for (const std::array<int, 3>& t : object.mesh.triangles)
      fmt::format_to(std::back_inserter(text), "f {} {} {}\n", first + static_cast<std::size_t>(t[0]),
                     first + static_cast<std::size_t>(t[1]), first + static_cast<std::size_t>(t[2]));
    first += object.mesh.points.size();
  }
  return text;
}

std::string ply_of(std::span<const Column> columns) {
  const std::size_t count = columns.empty() ? 0 : columns.front().values.size() / 4;
  std::string bytes = fmt::format("{}element vertex {}\n", ply_start, count);
  for (const Column& column : columns) bytes += fmt::format("property {} {}\n", column.integer ? "int" : "float", column.name);
  bytes += "end_header\n";
  const std::size_t start = bytes.size(), row = columns.size() * 4;
  bytes.resize(start + count * row);
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (std::size_t i = 0; i < count; ++i) std::memcpy(&bytes[start + i * row + c * 4], &columns[c].values[i * 4], 4);
  return bytes;
}

}  // namespace firn::stages
