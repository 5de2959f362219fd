#include "tests/fuzz/files.h"

#include <filesystem>
#include <stdexcept>

#include "scene/image.h"
#include "scene/mesh_solid.h"
#include "scene/npy.h"
#include "scene/points.h"
#include "tests/fuzz/refusal.h"

namespace firn::fuzz {
namespace {

namespace fs = std::filesystem;

void look_into(const scene::TriangleMesh& read) {
  scene::TriangleMesh mesh = read;
  if (!scene::mass_properties(mesh).center.allFinite()) throw std::logic_error("a centre of mass that is no number");
  static_cast<void>(scene::to_string(scene::repair(mesh)));
  const scene::MeshSolid solid(mesh);
  const scene::Vector3d middle = 0.5 * (solid.bounds().min + solid.bounds().max);
  static_cast<void>(solid.inside(middle));
  static_cast<void>(solid.inside(middle, 0.1));
  if (!(solid.distance(middle, 1) <= 1)) throw std::logic_error("a distance that is no number");
}

}  // namespace

void check_array(const Sandbox& sandbox, std::string_view bytes) {
  const fs::path file = sandbox.put("input.npy", bytes);
  read_or_refuse(file, [&] { static_cast<void>(scene::read_npy_header(file)); });
  read_or_refuse(file, [&] { static_cast<void>(scene::read_npy(file)); });
  read_or_refuse(file, [&] { static_cast<void>(scene::count_points(file.string())); });
  read_or_refuse(file, [&] { static_cast<void>(scene::read_points(file.string())); });
  read_or_refuse(file, [&] { static_cast<void>(scene::resample(scene::read_image(file.string(), 3, 5), 3, 5)); });
}

void check_image(const Sandbox& sandbox, std::string_view bytes) {
  const bool png = bytes.starts_with("\x89PNG");
  const fs::path file = sandbox.put(png ? "input.png" : "input.f32", bytes);
  read_or_refuse(file, [&] { static_cast<void>(scene::resample(scene::read_image(file.string(), 3, 5), 3, 5)); });
}

void check_mesh(const Sandbox& sandbox, std::string_view bytes) {
  if (bytes.empty()) return;
  const char* name = bytes[0] == 'o' ? "input.obj" : bytes[0] == 'p' ? "input.ply" : nullptr;
  if (name == nullptr) return;
  const fs::path file = sandbox.put(name, bytes.substr(1));
  read_or_refuse(file, [&] { look_into(scene::read_mesh(file.string(), 0.5)); });
}

void check_stl(const Sandbox& sandbox, std::string_view bytes) {
  const fs::path file = sandbox.put("input.stl", bytes);
  read_or_refuse(file, [&] { look_into(scene::read_mesh(file.string(), 0.5)); });
}

}  // namespace firn::fuzz
