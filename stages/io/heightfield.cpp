#include "stages/io/heightfield.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "stages/heightfield_ports.h"
#include "stages/mesh_files.h"
#include "stages/png.h"
#include "stages/vtk_files.h"

namespace firn::stages::io {
namespace {

using graph::Access;

class FieldFiles {
 public:
  struct Snapshot {
    Copy ground, depth, density;
    [[nodiscard]] std::size_t bytes() const { return ground.bytes() + depth.bytes() + density.bytes(); }
  };

  FieldFiles(std::shared_ptr<const Problem> problem, const graph::ParameterValues& parameters)
      : problem_(std::move(problem)),
        format_(choice(parameters, "format")),
        picture_(choice(parameters, "picture")),
        metres_(number(parameters, "metres")),
        level_(integer(parameters, "compression")),
        series_(export_folder(*problem_), "heightfield", format_) {}

  static Snapshot take(graph::HostContext& context) {
    return {Copy(context, "ground"), Copy(context, "depth"), Copy(context, "density")};
  }

  void write(const Snapshot& snapshot, std::uint64_t frame, double time) {
    const std::vector<float> ground = snapshot.ground.floats(), depth = snapshot.depth.floats();
    std::vector<float> surface(depth.size());
    std::transform(ground.begin(), ground.end(), depth.begin(), surface.begin(), std::plus<>());
    const std::filesystem::path file = series_.file(frame);
    if (format_ == "vti")
      write_file(file, vti(ground, depth, surface, snapshot.density.floats(), time));
    else if (format_ == "png")
      write_file(file, png(picture_ == "depth" ? depth : surface, file.filename().string()));
    else
      write_mesh(surface, file);
    series_.add(frame, time);
  }

 private:
  [[nodiscard]] const scene::Field& field() const { return *problem_->scene.field; }
  [[nodiscard]] double cell() const { return field().size.x() / field().cells_x; }
  // Of the cell in column x and row z.
  [[nodiscard]] scene::Vector3d center(int x, int z) const {
    return {field().origin.x() + (x + 0.5) * cell(), 0, field().origin.y() + (z + 0.5) * cell()};
  }

  // Nodes at the middles of cells, in a plane at height 0.
  [[nodiscard]] std::string vti(const std::vector<float>& ground, const std::vector<float>& depth,
                                const std::vector<float>& surface, const std::vector<float>& density, double time) const {
    vtk::Image image;
    const scene::Vector3d corner = center(0, 0);
    image.origin = {corner.x(), 0, corner.z()};
    image.spacing = {cell(), cell(), cell()};
    image.last = {field().cells_x - 1, 0, field().cells_z - 1};
    image.point_data = {vtk::array("surface", 1, surface, level_), vtk::array("depth", 1, depth, level_),
                        vtk::array("ground", 1, ground, level_), vtk::array("density", 1, density, level_)};
    return vtk::to_text(image, time);
  }

  std::string png(const std::vector<float>& heights, const std::string& name) {
    if (!scaled_) {
      const auto [low, high] = std::ranges::minmax(heights);
      black_ = picture_ == "depth" ? 0 : std::floor(static_cast<double>(low));
      // Twice what the first frame needs: snow is pushed up.
      if (metres_ <= 0) metres_ = std::exp2(std::ceil(std::log2(std::max(1e-3, 2 * (static_cast<double>(high) - black_)))));
      scaled_ = true;
    }
    std::vector<std::uint16_t> values(heights.size());
    std::size_t beyond = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const double share = (static_cast<double>(heights[i]) - black_) / metres_;
      beyond += share < 0 || share > 1 ? 1 : 0;
      values[i] = static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * 65535));
    }
    if (beyond > 0)
      spdlog::warn("{}: {} cells are beyond black or white; a larger io.heightfield.metres than {:g} is needed", name, beyond,
                   metres_);
    return png_of({field().cells_x, field().cells_z, std::move(values)},
                  {{"metres at black", fmt::format("{}", black_)}, {"metres at white", fmt::format("{}", black_ + metres_)}});
  }

  void write_mesh(const std::vector<float>& surface, const std::filesystem::path& file) const {
    const int columns = field().cells_x, rows = field().cells_z;
    NamedMesh snow{"snow", {}};
    for (int z = 0; z < rows; ++z)
      for (int x = 0; x < columns; ++x) {
        scene::Vector3d point = center(x, z);
        point.y() = static_cast<double>(
            surface[static_cast<std::size_t>(z) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)]);
        snow.mesh.points.push_back(point);
      }
    for (int z = 0; z + 1 < rows; ++z)
      for (int x = 0; x + 1 < columns; ++x) {
        const int a = z * columns + x, b = a + 1, c = a + columns, d = c + 1;
        snow.mesh.triangles.push_back({a, c, d});
        snow.mesh.triangles.push_back({a, d, b});
      }
    write_file(file, format_ == "obj" ? obj_of({&snow, 1}) : ply_of(snow.mesh));
  }

  std::shared_ptr<const Problem> problem_;
  std::string format_, picture_;
  double metres_;
  int level_;
  Series series_;
  double black_ = 0;  // height that is black, m
  bool scaled_ = false;
};

}  // namespace

graph::StageSpec heightfield_files() {
  return {
      .name = "io.heightfield",
      .doc = "The height field: export/heightfield_0000.vti and so on",
      .equation = "",
      .ports = {for_host(heightfield::port("ground", Access::read)), for_host(heightfield::port("depth", Access::read)),
                for_host(heightfield::port("density", Access::read))},
      .parameters = {format_parameter({"vti", "png", "obj", "ply"},
                                      "vti: ParaView, all values; png: 16 bits of grey; obj, ply: a mesh of the snow's surface"),
                     {.name = "picture",
                      .kind = graph::ParameterKind::choice,
                      .initial = std::string("depth"),
                      .choices = {"depth", "surface"},
                      .doc = "what a .png shows: depth, as scenes take it (depth: {image, metres}), or the height of the surface"},
                     {.name = "metres",
                      .initial = 0.0,
                      .min = 0.0,
                      .unit = "m",
                      .doc = "from black to white of a .png; 0: a power of two, twice what the first frame needs or more"},
                     compression_parameter()},
      .work = {graph::HostWork{}}};
}

graph::HostFactory writing_heightfield(const Exports& exports) { return exporting<FieldFiles>(exports); }

}  // namespace firn::stages::io
