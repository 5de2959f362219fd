#include "scene/mesh.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "config/diagnostics.h"
#include "scene/stl.h"

namespace firn::scene {

namespace {

[[noreturn]] void fail(const std::string& file, const std::string& text) {
  throw std::runtime_error(fmt::format("{}: {}", file, text));
}

// The fewest bytes that a value of this type takes: as text, a digit and a space.
double least_bytes(const std::string& type, bool text) {
  if (text) return 2;
  if (type == "double" || type == "float64") return 8;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  return 4;
}

// Assimp 5.2 reads for ever where a .ply file ends within its header, and takes memory for as many corners as a header promises.
void check_header(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  bool text = true;
  double promised = 0, count = 0;  // bytes; rows of the element that is being described
  for (int lines = 0; lines < 1000 && std::getline(stream, line); ++lines) {
    std::istringstream words(line);
    std::string word, second;
    words >> word >> second;
    if (word == "format") text = second == "ascii";
    if (word == "element") words >> count;
    if (word == "property") {
      if (second == "list") words >> second;  // at least the length of the list
      promised += count * least_bytes(second, text);
    }
    if (word != "end_header") continue;
    const double there = static_cast<double>(std::filesystem::file_size(file)) - static_cast<double>(stream.tellg());
    if (promised > there + 1)  // the last number may end with the file
      fail(file,
           fmt::format("this .ply file is cut off: its header promises {:.0f} bytes or more, but {:.0f} follow", promised, there));
    return;
  }
  fail(file, "this .ply file is broken: its header has no end (end_header)");
}

// The file's ending in small letters.
std::string checked_ending(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) fail(file, "this file does not exist");
  if (!std::filesystem::is_regular_file(file, error)) fail(file, "this is no file");
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  if (extension != ".obj" && extension != ".ply" && extension != ".stl")
    fail(file, fmt::format("a mesh must be an .obj, .ply or .stl file, not '{}'", extension));
  return extension;
}

// Are there polygons to be cut? Assimp's later steps rely on what is checked here and end the program where it is not so.
bool check_faces(const aiScene& content, const std::string& file) {
  bool polygons = false;
  for (unsigned m = 0; m < content.mNumMeshes; ++m) {
    const aiMesh& part = *content.mMeshes[m];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices == 0) fail(file, fmt::format("face {} of this mesh has no corners; is the file cut off?", f + 1));
      for (unsigned i = 0; i < face.mNumIndices; ++i)
        if (face.mIndices[i] >= part.mNumVertices)
          fail(file,
               fmt::format("face {} of this mesh names corner {}, but there are {}", f + 1, face.mIndices[i], part.mNumVertices));
      polygons = polygons || face.mNumIndices > 3;
    }
  }
  return polygons;
}

using Triangle = std::array<int, 3>;

double signed_volume(const TriangleMesh& mesh) {
  double volume = 0;
  const Vector3d& from = mesh.points.front();  // near the mesh, so that little cancels
  for (const Triangle& t : mesh.triangles)
    volume += (mesh.points[t[0]] - from).dot((mesh.points[t[1]] - from).cross(mesh.points[t[2]] - from)) / 6;
  return volume;
}

// Adds triangles as they come from the file: joins corners in one place, leaves out triangles without area.
class Joining {
 public:
  Joining(TriangleMesh& mesh, const std::string& file, double scale) : mesh_(mesh), file_(file), scale_(scale) {}
  // `number` of the corner in the file, from 0.
  int point(const Eigen::Vector3f& corner, std::size_t number) {
    const Vector3d place = scale_ * corner.cast<double>();
    if (!place.allFinite())
      fail(file_, fmt::format("corner {} of this mesh is ({}, {}, {}), but must be finite", number + 1, corner.x(), corner.y(),
                              corner.z()));
    const auto [at, fresh] = index_.try_emplace({place.x(), place.y(), place.z()}, static_cast<int>(mesh_.points.size()));
    if (fresh) mesh_.points.push_back(place);
    return at->second;
  }
  void triangle(const Triangle& t) {
    const Vector3d a = mesh_.points[t[1]] - mesh_.points[t[0]], b = mesh_.points[t[2]] - mesh_.points[t[0]];
    const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
    if (a.cross(b).norm() > 1e-12 * longest)
      mesh_.triangles.push_back(t);
    else
      ++mesh_.without_area;
  }

 private:
  TriangleMesh& mesh_;
  const std::string& file_;
  double scale_;
  std::map<std::array<double, 3>, int> index_;
};

void add_stl(const std::string& file, Joining& joining) {
  std::size_t corner = 0;
  for (const StlTriangle& triangle : read_stl(file)) {
    Triangle index;
    for (std::size_t i = 0; i < 3; ++i) index[i] = joining.point(triangle[i], corner++);
    joining.triangle(index);
  }
}

void add_by_assimp(const std::string& file, Joining& joining) {
  Assimp::Importer importer;
  const aiScene* content = importer.ReadFile(file, 0);
  if (content == nullptr) fail(file, fmt::format("this mesh cannot be read: {}", importer.GetErrorString()));
  if (check_faces(*content, file)) content = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (content == nullptr) fail(file, fmt::format("this mesh cannot be cut into triangles: {}", importer.GetErrorString()));
  for (unsigned m = 0; m < content->mNumMeshes; ++m) {
    const aiMesh& part = *content->mMeshes[m];
    std::vector<int> index(part.mNumVertices);
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const aiVector3D& corner = part.mVertices[v];
      index[v] = joining.point({corner.x, corner.y, corner.z}, v);
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices == 3) joining.triangle({index[face.mIndices[0]], index[face.mIndices[1]], index[face.mIndices[2]]});
    }
  }
}

MassProperties of_box(const TriangleMesh& mesh) {
  Vector3d low = mesh.points.front(), high = low;
  for (const Vector3d& point : mesh.points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Vector3d size = high - low, squared = size.cwiseProduct(size);
  MassProperties result;
  result.volume = size.prod();
  result.center = 0.5 * (low + high);
  result.inertia.diagonal() = result.volume / 12 * (Vector3d::Constant(squared.sum()) - squared);
  return result;
}

}  // namespace

TriangleMesh read_mesh(const std::string& file, double scale) {
  const std::string ending = checked_ending(file);
  TriangleMesh mesh;
  Joining joining(mesh, file, scale);
  if (ending == ".stl") {
    add_stl(file, joining);
  } else {
    if (ending == ".ply") check_header(file);
    add_by_assimp(file, joining);
  }
  if (mesh.triangles.empty()) fail(file, "this mesh has no triangles with an area");
  if (is_closed(mesh) && signed_volume(mesh) < 0)
    for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

std::vector<TriangleMesh> body_meshes(const Scene& scene) {
  std::vector<TriangleMesh> meshes;
  std::map<std::pair<std::string, double>, std::size_t> known;
  config::Diagnostics diagnostics;
  for (const Body& body : scene.bodies) {
    meshes.emplace_back();
    const auto* mesh = std::get_if<Mesh>(&body.shape);
    if (mesh == nullptr) continue;
    const auto [at, fresh] = known.try_emplace({mesh->file, mesh->scale}, meshes.size() - 1);
    try {
      meshes.back() = fresh ? read_mesh(mesh->file, mesh->scale) : meshes[at->second];
    } catch (const std::runtime_error& error) {
      diagnostics.error(body.place, error.what());
    }
  }
  config::throw_if_errors(diagnostics);
  return meshes;
}

bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> balance;  // of an edge, from its lower to its higher point
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = t[i], to = t[(i + 1) % 3];
      balance[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  return !balance.empty() && std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

// Tetrahedra from the first point to every triangle, signed. With a, b, c from there and s = a + b + c, a tetrahedron of volume V
// has the first moments V s/4 and the second moments V/20 (s s^T + a a^T + b b^T + c c^T) (Tonon 2004).
MassProperties mass_properties(const TriangleMesh& mesh) {
  if (!is_closed(mesh)) return of_box(mesh);
  const Vector3d from = mesh.points.front();
  double volume = 0;
  Vector3d first = Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vector3d a = mesh.points[t[0]] - from, b = mesh.points[t[1]] - from, c = mesh.points[t[2]] - from, sum = a + b + c;
    const double part = a.dot(b.cross(c)) / 6;
    volume += part;
    first += part / 4 * sum;
    second += part / 20 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  double reach = 0;
  for (const Vector3d& point : mesh.points) reach = std::max(reach, (point - from).norm());
  if (!(std::abs(volume) > 1e-12 * reach * reach * reach)) return of_box(mesh);  // folded flat: closed, but holds nothing
  MassProperties result;
  result.closed = true;
  result.volume = volume;
  const Vector3d shift = first / volume;
  result.center = from + shift;
  const Eigen::Matrix3d about = second - volume * shift * shift.transpose();  // parallel axes
  result.inertia = about.trace() * Eigen::Matrix3d::Identity() - about;
  return result;
}

}  // namespace firn::scene
