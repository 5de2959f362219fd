#include "stages/io/surface.h"

#include "stages/mesh_files.h"
#include "stages/mpm_ports.h"
#include "stages/snow_surface.h"
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
        shape_(surface_shape(parameters)),
        series_(export_folder(*problem_), "surface", format_) {
    if (!has_openvdb()) static_cast<void>(surface_of({}, 0, 0));
  }

  static Snapshot take(graph::HostContext& context) { return {Copy(context, "position"), Copy(context, "volume")}; }

  void write(const Snapshot& snapshot, std::uint64_t frame, double time) {
    const std::vector<float> position = snapshot.position.floats();
    const NodeField share = share_of_snow(position, snapshot.volume.floats(), position, *problem_->scene.domain, shape_);
    const NamedMesh mesh{"snow", snow_surface(share, shape_)};
    write_file(series_.file(frame), format_ == "ply" ? ply_of(mesh.mesh) : obj_of({&mesh, 1}));
    series_.add(frame, time);
  }

 private:
  std::shared_ptr<const Problem> problem_;
  std::string format_;
  SurfaceShape shape_;
  Series series_;
};

}  // namespace

graph::StageSpec surface() {
  std::vector<graph::ParameterSpec> parameters{format_parameter({"ply", "obj"}, "kind of file")};
  for (const graph::ParameterSpec& parameter : surface_parameters(0.4)) parameters.push_back(parameter);
  return {.name = "io.surface",
          .doc = "A closed mesh of triangles round the snow: export/surface_0000.ply and so on",
          .equation = "",
          .ports = {for_host(mpm::position(Access::read)), for_host(mpm::volume(Access::read))},
          .parameters = parameters,
          .work = {graph::HostWork{}}};
}

graph::HostFactory writing_surface(const Exports& exports) { return exporting<SurfaceFiles>(exports); }

}  // namespace firn::stages::io
