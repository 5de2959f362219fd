#include "stages/vdb_files.h"

#include <stdexcept>

#ifdef FIRN_OPENVDB

#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Filter.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <cstdint>
#include <sstream>

#include "scene/repeatable.h"

namespace firn::stages {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3SGrid;

// Writes to any stream in the form of files, with a table that readers can seek by; openvdb::io::File writes to files only, and
// does not say when the disk is full.
struct Archive : openvdb::io::Archive {
  using openvdb::io::Archive::write;
};

template <typename Grid>
typename Grid::Ptr grid_of(const NodeField& field, const char* name) {
  auto grid = Grid::create();
  auto transform = openvdb::math::Transform::createLinearTransform(field.cell);
  transform->postTranslate({field.origin.x(), field.origin.y(), field.origin.z()});
  grid->setTransform(transform);
  grid->setName(name);
  auto accessor = grid->getAccessor();
  for (const NodeField::Block& block : field.blocks) {
    auto* leaf = accessor.touchLeaf(Coord(block.first[0], block.first[1], block.first[2]));
    for (int z = 0; z < NodeField::edge; ++z)
      for (int y = 0; y < NodeField::edge; ++y)
        for (int x = 0; x < NodeField::edge; ++x) {
          const std::size_t n = NodeField::index(x, y, z);
          if (block.density[n] <= 0) continue;
          const openvdb::Index at = leaf->coordToOffset(Coord(x, y, z));
          if constexpr (std::is_same_v<Grid, FloatGrid>)
            leaf->setValueOn(at, block.density[n]);
          else
            leaf->setValueOn(at, openvdb::Vec3f(block.velocity[n][0], block.velocity[n][1], block.velocity[n][2]));
        }
  }
  return grid;
}

// OpenVDB gives every file a random name of its own (a UUID, right behind the versions). Equal contents are to make equal files.
void name_by_contents(std::string& file) {
  constexpr std::size_t start = 8 + 3 * 4 + 1, length = 36;
  std::uint64_t parts[2] = {1, 2};
  for (std::size_t i = start + length; i < file.size(); ++i)
    for (std::uint64_t& part : parts) part = scene::mix(part ^ static_cast<unsigned char>(file[i]));
  const std::string digits = fmt::format("{:016x}{:016x}", parts[0], parts[1]);
  file.replace(start, length,
               fmt::format("{}-{}-{}-{}-{}", digits.substr(0, 8), digits.substr(8, 4), digits.substr(12, 4), digits.substr(16, 4),
                           digits.substr(20)));
}

}  // namespace

bool has_openvdb() { return true; }

std::string vdb_of(const NodeField& field, double time) {
  openvdb::initialize();
  const auto density = grid_of<FloatGrid>(field, "density");
  density->setGridClass(openvdb::GRID_FOG_VOLUME);
  const auto velocity = grid_of<Vec3SGrid>(field, "velocity");
  velocity->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
  openvdb::MetaMap metadata;
  metadata.insertMeta("creator", openvdb::StringMetadata("Firn"));
  metadata.insertMeta("time", openvdb::DoubleMetadata(time));
  Archive archive;
  archive.setCompression(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK);
  std::ostringstream stream(std::ios::binary);
  archive.write(stream, openvdb::GridCPtrVec{density, velocity}, true, metadata);
  std::string file = std::move(stream).str();
  name_by_contents(file);
  return file;
}

scene::TriangleMesh surface_of(const NodeField& field, double level, int smoothing) {
  openvdb::initialize();
  const auto grid = grid_of<FloatGrid>(field, "density");
  if (smoothing > 0) {
    openvdb::tools::dilateActiveValues(grid->tree(), smoothing, openvdb::tools::NN_FACE_EDGE_VERTEX);
    openvdb::tools::Filter<FloatGrid>(*grid).mean(1, smoothing);
  }
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*grid, points, quads, level);
  scene::TriangleMesh mesh;
  mesh.points.reserve(points.size());
  for (const openvdb::Vec3s& p : points) mesh.points.emplace_back(p.x(), p.y(), p.z());
  mesh.triangles.reserve(quads.size() * 2);
  // OpenVDB's quads look to where values are higher, as level sets have it; density is higher within.
  for (const openvdb::Vec4I& q : quads) {
    const std::array<int, 4> c{static_cast<int>(q[0]), static_cast<int>(q[1]), static_cast<int>(q[2]), static_cast<int>(q[3])};
    mesh.triangles.push_back({c[0], c[2], c[1]});
    mesh.triangles.push_back({c[0], c[3], c[2]});
  }
  return mesh;
}

}  // namespace firn::stages

#else

namespace firn::stages {
namespace {

[[noreturn]] void fail() {
  throw std::runtime_error(
      "this build of Firn is without OpenVDB, which .vdb files and surfaces need; install its development package (libopenvdb-dev) "
      "and build again");
}

}  // namespace

bool has_openvdb() { return false; }
std::string vdb_of(const NodeField&, double) { fail(); }
scene::TriangleMesh surface_of(const NodeField&, double, int) { fail(); }

}  // namespace firn::stages

#endif
