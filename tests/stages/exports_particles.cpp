// Files of particles give back the numbers that were on the device.

#include <cmath>

#include "tests/stages/export_shot.h"

using namespace firn::test;
namespace fs = std::filesystem;

namespace {

// Frobenius norms of V_p0 P FE^T over V_p0.
std::vector<double> norms(const Shot& shot) {
  const std::vector<float> stress = shot.read("stress"), volume = shot.read("volume");
  std::vector<double> result;
  for (std::size_t p = 0; p < volume.size(); ++p) {
    double sum = 0;
    for (std::size_t i = 0; i < 9; ++i) sum += std::pow(static_cast<double>(stress[9 * p + i]), 2);
    result.push_back(std::sqrt(sum) / static_cast<double>(volume[p]));
  }
  return result;
}

void check_near(const std::vector<double>& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  double worst = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    worst = std::max(worst, std::abs(found[i] - expected[i]) / std::max(1.0, std::abs(expected[i])));
  CHECK(worst < 1e-6);
}

std::vector<double> every(const std::vector<double>& values, std::size_t start, std::size_t step) {
  std::vector<double> picked;
  for (std::size_t i = start; i < values.size(); i += step) picked.push_back(values[i]);
  return picked;
}

}  // namespace

TEST_CASE("particles as vtp read back equal, with their time, as one vertex each") {
  Folder folder;
  const std::string compression = GENERATE("0", "1", "9");
  Strained shot("[render.background, {io.particles: {compression: " + compression + "}}]", folder.path());
  write_frames(shot, 2);
  const VtkFile file = read_vtk(folder.path() / "export" / "particles_0001.vtp");
  const std::vector<double> position = doubles(shot.read("position"));
  CHECK(file.attribute("Piece", "NumberOfPoints") == std::to_string(position.size() / 3));
  CHECK(file.attribute("Piece", "NumberOfVerts") == std::to_string(position.size() / 3));
  CHECK(file.arrays.at("position") == position);
  CHECK(file.arrays.at("velocity") == doubles(shot.read("velocity")));
  CHECK(file.components.at("velocity") == 3);
  CHECK(file.arrays.at("J_P") == doubles(shot.read("plastic_det")));
  check_near(file.arrays.at("stress_norm"), norms(shot));
  CHECK(file.arrays.at("material") == materials(position.size() / 3));
  CHECK(file.arrays.at("TimeValue") == std::vector<double>{0.125});
  CHECK(file.arrays.at("connectivity").back() == static_cast<double>(position.size() / 3 - 1));
  CHECK(file.arrays.at("offsets").back() == static_cast<double>(position.size() / 3));
}

TEST_CASE("data of many blocks, the last of them full or not, come back whole") {
  Folder folder;
  SceneText scene;
  scene.snow = "[0, 0.2, 0]";
  std::string text = scene.text();
  text.replace(text.find("radius: 0.1"), 11, "radius: 0.7");
  Shot shot(text, "[mpm.seed]", "[render.background, io.particles]", small_image, folder.path().string());
  write_frames(shot, 1);
  const VtkFile file = read_vtk(folder.path() / "export" / "particles_0000.vtp");
  CHECK(file.arrays.at("position").size() * 4 > 1 << 20);
  CHECK(file.arrays.at("position") == doubles(shot.read("position")));
  CHECK(file.arrays.count("stress_norm") == 0);  // nobody wrote a stress
}

TEST_CASE("particles as ply and npy read back equal") {
  Folder folder;
  Strained shot("[render.background, {io.particles: {format: ply}}, {io.particles: {format: npy}}]", folder.path());
  write_frames(shot, 1);
  const std::vector<double> position = doubles(shot.read("position")), velocity = doubles(shot.read("velocity"));
  const PlyFile ply = read_ply(folder.path() / "export" / "particles_0000.ply");
  const NpyFile npy = read_npy_file(folder.path() / "export" / "particles_0000.npy");
  CHECK(npy.shape == std::vector<std::size_t>{position.size() / 3, 6});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(ply.columns.at(std::string(1, "xyz"[axis])) == every(position, axis, 3));
    CHECK(ply.columns.at(std::string("v") + "xyz"[axis]) == every(velocity, axis, 3));
    CHECK(every(npy.values, axis, 6) == every(position, axis, 3));
    CHECK(every(npy.values, axis + 3, 6) == every(velocity, axis, 3));
  }
  CHECK(ply.columns.at("J_P") == doubles(shot.read("plastic_det")));
  CHECK(read_npy_file(folder.path() / "export" / "particles_0000_J_P.npy").values == doubles(shot.read("plastic_det")));
  check_near(read_npy_file(folder.path() / "export" / "particles_0000_stress_norm.npy").values, norms(shot));
  CHECK(read_npy_file(folder.path() / "export" / "particles_0000_material.npy").values == materials(position.size() / 3));
  CHECK(ply.columns.at("material") == materials(position.size() / 3));
}

TEST_CASE("files are the smaller the more they are compressed") {
  std::vector<std::uintmax_t> sizes;
  for (const char* compression : {"0", "1", "9"}) {
    Folder folder;
    Strained shot(std::string("[render.background, {io.particles: {compression: ") + compression + "}}]", folder.path());
    write_frames(shot, 1);
    sizes.push_back(fs::file_size(folder.path() / "export" / "particles_0000.vtp"));
  }
  CHECK(sizes[0] > sizes[1]);
  CHECK(sizes[1] > sizes[2]);
}
