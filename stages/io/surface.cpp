#include "stages/io/surface.h"

#include "stages/mesh_files.h"
#include "stages/mpm_ports.h"
#include "stages/vdb_files.h"

namespace firn::stages::io {
namespace {

using graph::Access;

class SurfaceFiles {
 public:
  struct Snapshot {
    Copy position, volume;
    [[nodiscard]] std::size_t bytes() const { return position.bytes() + volume.bytes(); }
  };

  SurfaceFiles(std::shared_ptr<const Problem> problem, const graph::ParameterValues& parameters)
      : problem_(std::move(problem)),
        format_(choice(parameters, "format")),
        cell_(number(parameters, "cell")),
        level_(number(parameters, "level")),
        smoothing_(integer(parameters, "smoothing")),
        series_(export_folder(*problem_), "surface", format_) {
    if (!has_openvdb()) static_cast<void>(surface_of({}, 0, 0));
  }

  static Snapshot take(graph::HostContext& context) { return {Copy(context, "position"), Copy(context, "volume")}; }

  // Initial volumes in place of masses make the share of space that snow fills, in whatever material: 1 as it was laid.
  void write(const Snapshot& snapshot, std::uint64_t frame, double time) {
    const scene::Domain& domain = *problem_->scene.domain;
    const std::vector<float> position = snapshot.position.floats();
    const NodeField field = node_field(position, position, snapshot.volume.floats(), domain.min, cell_ * domain.cell);
    const NamedMesh mesh{"snow", surface_of(field, level_, smoothing_)};
    write_file(series_.file(frame), format_ == "ply" ? ply_of(mesh.mesh) : obj_of({&mesh, 1}));
    series_.add(frame, time);
  }

 private:
  std::shared_ptr<const Problem> problem_;
  std::string format_;
  double cell_, level_;
  int smoothing_;
  Series series_;
};

}  // namespace

graph::StageSpec surface() {
  return {.name = "io.surface",
          .doc = "A closed mesh of triangles round the snow: export/surface_0000.ply and so on",
          .equation = "",
          .ports = {for_host(mpm::position(Access::read)), for_host(mpm::volume(Access::read))},
          .parameters = {format_parameter({"ply", "obj"}, "kind of file"),
                         {.name = "cell",
                          .initial = 1.0,
                          .min = 0.25,
                          .max = 4.0,
                          .unit = "1",
                          .doc = "edge of the mesh's cells, in cells of the grid; below the distance of particles it has holes"},
                         {.name = "level",
                          .initial = 0.4,
                          .min = 0.01,
                          .max = 2.0,
                          .unit = "1",
                          .doc = "share of space, as snow was laid, that counts as inside"},
                         {.name = "smoothing",
                          .kind = graph::ParameterKind::integer,
                          .initial = std::int64_t{1},
                          .min = 0,
                          .max = 20,
                          .unit = "1",
                          .doc = "passes that even out the density before"}},
          .work = {graph::HostWork{}}};
}

graph::HostFactory writing_surface(const Exports& exports) { return exporting<SurfaceFiles>(exports); }

}  // namespace firn::stages::io
