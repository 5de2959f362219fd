#include "stages/io/grid.h"

#include "stages/mpm_ports.h"
#include "stages/node_field.h"
#include "stages/vdb_files.h"
#include "stages/vtk_files.h"

namespace firn::stages::io {
namespace {

using graph::Access;

class GridFiles {
 public:
  struct Snapshot {
    Copy position, velocity, mass;
    [[nodiscard]] std::size_t bytes() const { return position.bytes() + velocity.bytes() + mass.bytes(); }
  };

  GridFiles(std::shared_ptr<const Problem> problem, const graph::ParameterValues& parameters)
      : problem_(std::move(problem)),
        format_(choice(parameters, "format")),
        level_(integer(parameters, "compression")),
        series_(export_folder(*problem_), "grid", format_) {
    if (format_ == "vdb" && !has_openvdb()) static_cast<void>(vdb_of({}, 0));
  }

  static Snapshot take(graph::HostContext& context) {
    return {Copy(context, "position"), Copy(context, "velocity"), Copy(context, "mass")};
  }

  void write(const Snapshot& snapshot, std::uint64_t frame, double time) {
    const scene::Domain& domain = *problem_->scene.domain;
    const NodeField field =
        node_field(snapshot.position.floats(), snapshot.velocity.floats(), snapshot.mass.floats(), domain.min, domain.cell);
    write_file(series_.file(frame), format_ == "vdb" ? vdb_of(field, time) : vti(field, time));
    series_.add(frame, time);
  }

 private:
  [[nodiscard]] std::string vti(const NodeField& field, double time) const {
    // The whole grid in every frame: ParaView takes the extent of a series from its first file.
    const Eigen::Vector3i nodes = problem_->scene.domain->nodes();
    const std::array<int, 3> last{nodes.x() - 1, nodes.y() - 1, nodes.z() - 1};
    const DenseField values = dense(field, last);
    vtk::Image image;
    image.origin = {field.origin.x(), field.origin.y(), field.origin.z()};
    image.spacing = {field.cell, field.cell, field.cell};
    image.last = last;
    image.point_data = {vtk::array("density", 1, values.density, level_), vtk::array("velocity", 3, values.velocity, level_)};
    return vtk::to_text(image, time);
  }

  std::shared_ptr<const Problem> problem_;
  std::string format_;
  int level_;
  Series series_;
};

}  // namespace

graph::StageSpec grid() {
  return {
      .name = "io.grid",
      .doc = "Density and velocity of the particles on the nodes of the grid: export/grid_0000.vdb and so on",
      .equation = "[M 17-20], quadratic kernel, from where the particles are in this frame",
      .ports = {for_host(mpm::position(Access::read)), for_host(mpm::velocity(Access::read)), for_host(mpm::mass(Access::read))},
      .parameters = {format_parameter({"vdb", "vti"}, "vdb: Blender, Houdini; vti: ParaView, all nodes of the grid"),
                     compression_parameter()},
      .work = {graph::HostWork{}}};
}

graph::HostFactory writing_grid(const Exports& exports) { return exporting<GridFiles>(exports); }

}  // namespace firn::stages::io
