// What .vdb files say, by OpenVDB's own reader of files.

#include "stages/vdb_files.h"
#include "tests/catch.h"

#ifdef FIRN_OPENVDB

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <fstream>

#include "tests/graph/folder.h"

using firn::stages::NodeField;

TEST_CASE("a vdb file has both grids with their values where the nodes are") {
  const std::vector<float> position{0.31f, 1.02f, -0.73f, 0.35f, 1.0f, -0.7f, 4.0f, 2.0f, -3.0f};
  const std::vector<float> velocity{1, 2, 3, -1, 0, 2, 5, 5, 5}, mass{0.5f, 0.25f, 2};
  const Eigen::Vector3d origin(-1.5, 0.25, -3.5);
  const NodeField field = firn::stages::node_field(position, velocity, mass, origin, 0.1);
  firn::test::Folder folder;
  const auto file_name = folder.write("grid.vdb", firn::stages::vdb_of(field, 0.75)).string();

  openvdb::initialize();
  openvdb::io::File file(file_name);
  file.open(false);
  CHECK(file.getMetadata()->metaValue<double>("time") == 0.75);
  const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
  const auto speed = openvdb::gridPtrCast<openvdb::Vec3SGrid>(file.readGrid("velocity"));
  REQUIRE(density);
  REQUIRE(speed);
  CHECK(density->getGridClass() == openvdb::GRID_FOG_VOLUME);
  CHECK(speed->getVectorType() == openvdb::VEC_CONTRAVARIANT_RELATIVE);
  double total = 0;
  openvdb::Vec3d center(0), momentum(0);
  for (auto value = density->cbeginValueOn(); value; ++value) {
    const double m = static_cast<double>(*value) * 1e-3;
    total += m;
    center += m * density->indexToWorld(value.getCoord());
    momentum += m * openvdb::Vec3d(speed->tree().getValue(value.getCoord()));
  }
  CHECK(density->activeVoxelCount() == speed->activeVoxelCount());
  CHECK(total == Approx(2.75).epsilon(1e-5));
  for (int a = 0; a < 3; ++a) {
    double place = 0, push = 0;
    for (std::size_t p = 0; p < 3; ++p) {
      place += static_cast<double>(mass[p]) * static_cast<double>(position[3 * p + static_cast<std::size_t>(a)]);
      push += static_cast<double>(mass[p]) * static_cast<double>(velocity[3 * p + static_cast<std::size_t>(a)]);
    }
    CHECK(center[a] == Approx(place).epsilon(1e-4));
    CHECK(momentum[a] == Approx(push).epsilon(1e-4));
  }
}

TEST_CASE("equal fields make equal vdb files, others files of another name") {
  const std::vector<float> position{0.3f, 1.0f, -0.7f}, velocity{1, 2, 3}, mass{0.5f};
  const Eigen::Vector3d origin(-1.5, 0.25, -3.5);
  const NodeField field = firn::stages::node_field(position, velocity, mass, origin, 0.1);
  const std::string one = firn::stages::vdb_of(field, 0.75), again = firn::stages::vdb_of(field, 0.75),
                    later = firn::stages::vdb_of(field, 0.76);
  CHECK(one == again);
  const firn::test::Folder folder;
  const auto name_of = [&](const std::string& bytes) {
    openvdb::initialize();
    openvdb::io::File file(folder.write("grid.vdb", bytes).string());
    file.open(false);
    return file.getUniqueTag();
  };
  CHECK(name_of(one).size() == 36);
  CHECK(name_of(one) != name_of(later));
}

#endif
