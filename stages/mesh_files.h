#pragma once

// Meshes and points as PLY (binary, little endian) and OBJ (text).

#include <span>
#include <string>
#include <vector>

#include "scene/mesh.h"

namespace firn::stages {

struct NamedMesh {
  std::string name;
  scene::TriangleMesh mesh;
};

std::string ply_of(const scene::TriangleMesh& mesh);
std::string obj_of(std::span<const NamedMesh> objects);  // one object each

// Points with whatever they carry: one 4-byte value per point and column.
struct Column {
  std::string name;               // "x"
  bool integer = false;           // int, else float
  std::vector<std::byte> values;  // of all points
};
std::string ply_of(std::span<const Column> columns);

}  // namespace firn::stages
