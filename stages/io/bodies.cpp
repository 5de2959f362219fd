#include "stages/io/bodies.h"

#include <fmt/format.h>

#include <iterator>

#include "stages/body_meshes.h"
#include "stages/heightfield_ports.h"
#include "stages/mesh_files.h"
#include "stages/mpm_ports.h"
#include "stages/vtk_files.h"

namespace firn::stages::io {
namespace {

using graph::Access;

struct Pose {
  scene::Vector3d position;
  scene::Quaterniond orientation;
};

// Long enough that the square of a half-space reaches all over the scene from any point of it.
double plane_edge(const scene::Scene& scene) {
  double edge = 10;
  if (scene.domain) edge = 2 * (scene.domain->max - scene.domain->min).norm();
  if (scene.field) edge = std::max(edge, 2 * scene.field->size.norm());
  return edge;
}

class BodyFiles {
 public:
  struct Snapshot {
    Copy kind, size, position, orientation, corners, corners_of;
    [[nodiscard]] std::size_t bytes() const {
      return kind.bytes() + size.bytes() + position.bytes() + orientation.bytes() + corners.bytes() + corners_of.bytes();
    }
  };

  BodyFiles(std::shared_ptr<const Problem> problem, const graph::ParameterValues& parameters)
      : problem_(std::move(problem)),
        format_(choice(parameters, "format")),
        level_(integer(parameters, "compression")),
        series_(export_folder(*problem_), "bodies", format_ == "poses" ? "csv" : format_) {}

  static Snapshot take(graph::HostContext& context) {
    return {Copy(context, "body_kind"),        Copy(context, "body_size"),    Copy(context, "body_position"),
            Copy(context, "body_orientation"), Copy(context, "facet_points"), Copy(context, "facet_body")};
  }

  void write(const Snapshot& snapshot, std::uint64_t frame, double time) {
    const std::filesystem::path file = series_.file(frame);
    if (meshes_.empty()) make_meshes(snapshot);
    const std::vector<float> position = snapshot.position.floats(), orientation = snapshot.orientation.floats();
    std::vector<Pose> poses;
    for (std::size_t b = 0; b < meshes_.size(); ++b) {
      const float *p = &position[3 * b], *q = &orientation[4 * b];
      poses.push_back({scene::Vector3d(p[0], p[1], p[2]), scene::Quaterniond(q[3], q[0], q[1], q[2])});
    }
    if (format_ == "poses") {
      write_file(file, table(poses, frame, time));
    } else {
      std::vector<NamedMesh> objects = meshes_;
      for (std::size_t b = 0; b < objects.size(); ++b)
        objects[b].mesh = placed(std::move(objects[b].mesh), poses[b].position, poses[b].orientation);
      write_file(file, format_ == "obj" ? obj_of(objects) : vtp(objects, time));
    }
    series_.add(frame, time);
  }

 private:
  void make_meshes(const Snapshot& snapshot) {
    const std::vector<std::int32_t> kind = snapshot.kind.integers(), of = snapshot.corners_of.integers();
    const std::vector<float> size = snapshot.size.floats(), corners = snapshot.corners.floats();
    std::vector<BodyShape> shapes(kind.size());
    for (std::size_t b = 0; b < kind.size(); ++b) {
      shapes[b].kind = kind[b];
      for (std::size_t i = 0; i < 4; ++i) shapes[b].size[static_cast<Eigen::Index>(i)] = static_cast<double>(size[4 * b + i]);
    }
    for (std::size_t c = 0; c < of.size() * 3; ++c)
      shapes[static_cast<std::size_t>(of[c / 3])].corners.emplace_back(corners[3 * c], corners[3 * c + 1], corners[3 * c + 2]);
    for (std::size_t b = 0; b < shapes.size(); ++b) {
      meshes_.push_back({problem_->scene.bodies[b].name, mesh_of(shapes[b], plane_edge(problem_->scene))});
      if (format_ == "poses") write_file(export_folder(*problem_) / fmt::format("body_{:03}.obj", b), obj_of({&meshes_.back(), 1}));
    }
  }

  [[nodiscard]] std::string table(const std::vector<Pose>& poses, std::uint64_t frame, double time) const {
    std::string text = "frame,time,body,name,mesh,x,y,z,qx,qy,qz,qw\n";
    for (std::size_t b = 0; b < poses.size(); ++b) {
      std::string name;
      for (const char c : meshes_[b].name) name += c == '"' ? std::string("\"\"") : std::string(1, c);
      const auto& [p, q] = poses[b];
      fmt::format_to(std::back_inserter(text), "{},{},{},\"{}\",body_{:03}.obj,{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n",
                     frame, time, b, name, b, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
    }
    return text;
  }

  [[nodiscard]] std::string vtp(const std::vector<NamedMesh>& objects, double time) const {
    std::vector<float> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<std::int32_t> body;
    for (std::size_t b = 0; b < objects.size(); ++b) {
      const int first = static_cast<int>(points.size() / 3);
      for (const scene::Vector3d& point : objects[b].mesh.points)
        for (const double part : point) points.push_back(static_cast<float>(part));
      for (const std::array<int, 3>& t : objects[b].mesh.triangles) {
        triangles.push_back({first + t[0], first + t[1], first + t[2]});
        body.push_back(static_cast<std::int32_t>(b));
      }
    }
    vtk::PolyData data;
    data.points_count = points.size() / 3;
    data.points = vtk::array("position", 3, points, level_);
    data.cells = vtk::triangles(triangles, level_);
    data.cell_data = {vtk::array("body", 1, body, level_)};
    return vtk::to_text(data, time);
  }

  std::shared_ptr<const Problem> problem_;
  std::string format_;
  int level_;
  Series series_;
  std::vector<NamedMesh> meshes_;  // in the bodies' own axes
};

}  // namespace

graph::StageSpec bodies() {
  graph::StageSpec spec{.name = "io.bodies",
                        .doc = "Rigid bodies as meshes where they are: export/bodies_0000.vtp and so on",
                        .equation = "",
                        .ports = {},
                        .parameters = {format_parameter({"vtp", "obj", "poses"},
                                                        "vtp: ParaView; obj: an object per body; poses: a table per frame, and the "
                                                        "meshes once, in the bodies' own axes"),
                                       compression_parameter()},
                        .work = {graph::HostWork{}}};
  for (const char* name : {"body_kind", "body_size", "body_position", "body_orientation"})
    spec.ports.push_back(for_host(mpm::body(name, Access::read)));
  for (const char* name : {"facet_points", "facet_body"})
    spec.ports.push_back(for_host(heightfield::port(name, Access::read), true));
  return spec;
}

graph::HostFactory writing_bodies(const Exports& exports) { return exporting<BodyFiles>(exports); }

}  // namespace firn::stages::io
