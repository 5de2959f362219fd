// Prints a bunny as OBJ: eleven soft ellipsoids as one closed mesh. It stands on y = 0, looks along +x, and is 1 m high.
// pipelines/scenes/meshes/bunny.obj was made by `make_bunny 40`: the number is how many cells go into its height.

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "stages/mesh_files.h"
#include "stages/vdb_files.h"

namespace {

using Eigen::Vector3d;

struct Ellipsoid {
  Vector3d center, radii;
  double pitch;  // degrees about z: raises what lies along +x
  double yaw;    // degrees about y
};

std::vector<Ellipsoid> parts() {
  std::vector<Ellipsoid> list{{{-0.05, 0.27, 0}, {0.34, 0.25, 0.24}, 12, 0},     // body
                              {{-0.20, 0.22, 0}, {0.20, 0.20, 0.25}, 0, 0},      // rump
                              {{0.22, 0.34, 0}, {0.15, 0.22, 0.15}, -20, 0},     // chest
                              {{0.33, 0.58, 0}, {0.18, 0.14, 0.135}, -12, 0},    // head
                              {{-0.42, 0.24, 0}, {0.085, 0.085, 0.085}, 0, 0}};  // tail
  for (const double side : {-1.0, 1.0}) {
    list.push_back({{0.22, 0.81, side * 0.085}, {0.20, 0.045, 0.06}, 112, side * -14});  // ear
    list.push_back({{-0.16, 0.055, side * 0.17}, {0.19, 0.055, 0.075}, 0, side * 6});    // hind foot
    list.push_back({{0.27, 0.10, side * 0.09}, {0.07, 0.10, 0.055}, 0, 0});              // fore leg
  }
  return list;
}

// Positive within, about the distance from the surface in metres.
double depth(const Ellipsoid& part, const Vector3d& point) {
  constexpr double degree = M_PI / 180;
  const Eigen::Quaterniond turn =
      Eigen::AngleAxisd(part.yaw * degree, Vector3d::UnitY()) * Eigen::AngleAxisd(part.pitch * degree, Vector3d::UnitZ());
  const Vector3d own = turn.conjugate() * (point - part.center);
  const double share = own.cwiseQuotient(part.radii).norm();
  const double slope = own.cwiseQuotient(part.radii.cwiseProduct(part.radii)).norm();
  return share > 1e-9 ? (1 - share) * share / slope : part.radii.minCoeff();
}

}  // namespace

int main(int argc, char** argv) {
  const int cells = argc > 1 ? std::atoi(argv[1]) : 40;
  if (cells < 8 || cells > 1000) {
    fmt::print(stderr, "usage: make_bunny CELLS   (8 to 1000 in its height)\n");
    return 2;
  }
  constexpr double softness = 60;  // 1/m: how sharply parts meet
  firn::stages::NodeField field;
  field.cell = 1.0 / cells;
  const std::vector<Ellipsoid> list = parts();
  const int reach = (cells * 3 / 4 / 8 + 1) * 8;
  for (int z = -reach; z < reach; z += 8)
    for (int y = -8; y < cells + cells / 4; y += 8)
      for (int x = -reach; x < reach; x += 8) {
        firn::stages::NodeField::Block& block = field.blocks.emplace_back();
        block.first = {x, y, z};
        for (int n = 0; n < firn::stages::NodeField::size; ++n) {
          const Vector3d point = field.cell * Vector3d(x + n % 8, y + n / 8 % 8, z + n / 64);
          double sum = 0;
          for (const Ellipsoid& part : list) sum += std::exp(std::min(40.0, softness * depth(part, point)));
          block.density[static_cast<std::size_t>(n)] = static_cast<float>(std::log(sum) / softness + 10);  // all positive
        }
      }
  firn::stages::NamedMesh bunny{"bunny", firn::stages::surface_of(field, 10, 0)};
  double low = 1e9, high = -1e9;
  for (const Vector3d& point : bunny.mesh.points) {
    low = std::min(low, point.y());
    high = std::max(high, point.y());
  }
  for (Vector3d& point : bunny.mesh.points) point = (point - Vector3d(0, low, 0)) / (high - low);
  fmt::print("{}", firn::stages::obj_of({&bunny, 1}));
  return 0;
}
