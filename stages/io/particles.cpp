#include "stages/io/particles.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/npy.h"
#include "stages/mesh_files.h"
#include "stages/mpm_ports.h"
#include "stages/vtk_files.h"

namespace firn::stages::io {
namespace {

using graph::Access;

// Frobenius norm of the Kirchhoff stress P(FE) FE^T, Pa; `stress` has it times the initial volume.
std::vector<float> stress_norms(const std::vector<float>& stress, const std::vector<float>& volume) {
  std::vector<float> norms(volume.size());
  for (std::size_t p = 0; p < norms.size(); ++p) {
    double sum = 0;
    for (std::size_t i = 9 * p; i < 9 * p + 9; ++i) sum += static_cast<double>(stress[i]) * static_cast<double>(stress[i]);
    norms[p] = static_cast<float>(std::sqrt(sum) / static_cast<double>(volume[p]));
  }
  return norms;
}

struct Values {
  std::vector<float> position, velocity, plastic_det, stress_norm;
  std::vector<std::int32_t> material;

  // Where there are no particles, files have all columns, without a row.
  [[nodiscard]] bool has(const auto& column) const { return !column.empty() || position.empty(); }
};

std::vector<std::byte> bytes_of(const auto& values, std::size_t component, std::size_t components) {
  std::vector<std::byte> bytes(values.size() / components * 4);
  for (std::size_t i = 0; i < bytes.size() / 4; ++i) std::memcpy(&bytes[i * 4], &values[i * components + component], 4);
  return bytes;
}

class ParticleFiles {
 public:
  struct Snapshot {
    Copy position, velocity, volume, plastic_det, stress, material;
    [[nodiscard]] std::size_t bytes() const {
      return position.bytes() + velocity.bytes() + volume.bytes() + plastic_det.bytes() + stress.bytes() + material.bytes();
    }
  };

  ParticleFiles(const std::shared_ptr<const Problem>& problem, const graph::ParameterValues& parameters)
      : format_(choice(parameters, "format")),
        level_(integer(parameters, "compression")),
        series_(export_folder(*problem), "particles", format_) {}

  static Snapshot take(graph::HostContext& context) {
    const bool has_stress = context.bound("stress") && context.bound("volume");
    return {Copy(context, "position"),
            Copy(context, "velocity"),
            has_stress ? Copy(context, "volume") : Copy(),
            Copy(context, "plastic_det"),
            has_stress ? Copy(context, "stress") : Copy(),
            Copy(context, "material")};
  }

  void write(const Snapshot& snapshot, std::uint64_t frame, double time) {
    Values values{
        snapshot.position.floats(), snapshot.velocity.floats(), snapshot.plastic_det.floats(), {}, snapshot.material.integers()};
    if (!snapshot.stress.empty()) values.stress_norm = stress_norms(snapshot.stress.floats(), snapshot.volume.floats());
    if (format_ == "vtp")
      write_file(series_.file(frame), vtp(values, time));
    else if (format_ == "ply")
      write_file(series_.file(frame), ply(values));
    else
      npy(values, frame);
    series_.add(frame, time);
  }

 private:
  std::string vtp(const Values& values, double time) {
    vtk::PolyData data;
    data.points_count = values.position.size() / 3;
    data.points = vtk::array("position", 3, values.position, level_);
    if (cells_.count != data.points_count || cells_.kind.empty()) cells_ = vtk::one_per_point(data.points_count, level_);
    data.cells = cells_;
    const auto add = [&](const char* name, int components, const auto& array) {
      if (values.has(array)) data.point_data.push_back(vtk::array(name, components, std::span(array), level_));
    };
    add("velocity", 3, values.velocity);
    add("J_P", 1, values.plastic_det);
    add("stress_norm", 1, values.stress_norm);
    add("material", 1, values.material);
    return vtk::to_text(data, time);
  }

  static std::string ply(const Values& values) {
    std::vector<Column> columns;
    const auto add = [&](const char* name, const auto& array, std::size_t component = 0, std::size_t components = 1) {
      using T = std::decay_t<decltype(array[0])>;
      if (values.has(array)) columns.push_back({name, std::is_integral_v<T>, bytes_of(array, component, components)});
    };
    for (std::size_t axis = 0; const char* name : {"x", "y", "z"}) add(name, values.position, axis++, 3);
    for (std::size_t axis = 0; const char* name : {"vx", "vy", "vz"}) add(name, values.velocity, axis++, 3);
    add("J_P", values.plastic_det);
    add("stress_norm", values.stress_norm);
    add("material", values.material);
    return ply_of(columns);
  }

  // Places and velocities as scenes take them (points: {file}); the rest as arrays of their own.
  void npy(const Values& values, std::uint64_t frame) {
    const std::size_t count = values.position.size() / 3;
    std::vector<float> rows(count * 6);
    for (std::size_t p = 0; p < count; ++p)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        rows[6 * p + axis] = values.position[3 * p + axis];
        rows[6 * p + 3 + axis] = values.velocity[3 * p + axis];
      }
    const auto write = [&](const char* suffix, const scene::NpyShape& shape, const auto& array) {
      if (array.empty() && count > 0) return;
      write_beside(series_.file(frame, suffix), [&](const std::filesystem::path& part) {
        scene::write_npy(part, shape, std::span<const typename std::decay_t<decltype(array)>::value_type>(array));
      });
    };
    write("", {count, 6}, rows);
    write("_J_P", {count}, values.plastic_det);
    write("_stress_norm", {count}, values.stress_norm);
    write("_material", {count}, values.material);
  }

  std::string format_;
  int level_;
  Series series_;
  vtk::Cells cells_;  // the same in every frame while the number of particles is
};

}  // namespace

graph::StageSpec particles() {
  return {.name = "io.particles",
          .doc = "Every particle with velocity, J_P, stress and material: export/particles_0000.vtp and so on",
          .equation = "",
          .ports = {for_host(mpm::position(Access::read)), for_host(mpm::velocity(Access::read)),
                    for_host(mpm::volume(Access::read), true), for_host(mpm::plastic_det(Access::read), true),
                    for_host(mpm::stress(Access::read), true), for_host(mpm::material(Access::read), true)},
          .parameters = {format_parameter({"vtp", "ply", "npy"},
                                          "vtp: ParaView; ply: Blender, Houdini and others; npy: NumPy, (N, 6) of position and "
                                          "velocity, as scenes take points, and an array each of the rest"),
                         compression_parameter()},
          .work = {graph::HostWork{}}};
}

graph::HostFactory writing_particles(const Exports& exports) { return exporting<ParticleFiles>(exports); }

}  // namespace firn::stages::io
