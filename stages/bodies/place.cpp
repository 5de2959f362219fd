#include "stages/bodies/place.h"

#include "scene/inertia.h"
#include "stages/body_distance.h"
#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::stages::bodies {
namespace {

using graph::Access;
using graph::Usage;
using scene::Quaterniond;
using scene::Vector3d;

enum Kind : std::int32_t { half_space = 0, sphere = 1, box = 2, capsule = 3, mesh = 4 };  // as shaders/lib/bodies.glsl has it

void put(std::vector<float>& values, std::initializer_list<double> parts) {
  for (const double part : parts) values.push_back(static_cast<float>(part));
}
void put(std::vector<float>& values, const Vector3d& v) { put(values, {v.x(), v.y(), v.z()}); }
void put(std::vector<float>& values, const Quaterniond& q) { put(values, {q.x(), q.y(), q.z(), q.w()}); }

// A body as the GPU wants it: every shape about its own centre, along its own axes, which are those of its inertia. A capsule's
// axis is local y.
struct Placed {
  Kind kind = sphere;
  Eigen::Vector4d size{0, 0, 0, 0};
  Vector3d offset{0, 0, 0};  // of that centre in the scene's axes of the body
  Quaterniond turn = Quaterniond::Identity();
  Vector3d moments{0, 0, 0};      // kg m2; 0: nothing turns it
  std::vector<Vector3d> corners;  // of its facets, three each
};

std::vector<Vector3d> box_corners(const Vector3d& half) {
  std::vector<Vector3d> corners;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto corner = [&](double u, double v) {
        Vector3d point;
        point[axis] = side * half[axis];
        point[(axis + 1) % 3] = side * u * half[(axis + 1) % 3];  // so that every face is counter-clockwise seen from outside
        point[(axis + 2) % 3] = v * half[(axis + 2) % 3];
        return point;
      };
      for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}) corners.push_back(corner(u, v));
    }
  return corners;
}

Placed placed(const scene::Body& body, const scene::TriangleMesh& triangles) {
  Placed result;
  const Vector3d up = Vector3d::UnitY();
  const auto moments = [&] { return body.mass ? scene::inertia_of(body.shape, *body.mass).moments : Vector3d(0, 0, 0); };
  if (const auto* plane = std::get_if<scene::Plane>(&body.shape)) {
    result.kind = half_space;
    result.offset = plane->point;
    result.turn = Quaterniond::FromTwoVectors(up, plane->normal);
  } else if (const auto* ball = std::get_if<scene::Sphere>(&body.shape)) {
    result.kind = sphere;
    result.size.x() = ball->radius;
    result.offset = ball->center;
    result.moments = moments();
  } else if (const auto* block = std::get_if<scene::Box>(&body.shape)) {
    result.kind = box;
    result.size << block->half_size, facets_are_swept(body) ? 1.0 : 0.0;
    result.offset = block->center;
    result.moments = moments();
    result.corners = box_corners(block->half_size);
  } else if (const auto* rod = std::get_if<scene::Capsule>(&body.shape)) {
    result.kind = capsule;
    const Vector3d axis = rod->end - rod->start;
    result.size.head<2>() = Eigen::Vector2d(rod->radius, 0.5 * axis.norm());
    result.offset = 0.5 * (rod->start + rod->end);
    if (axis.norm() > 0) result.turn = Quaterniond::FromTwoVectors(up, axis);
    const Vector3d own = moments();  // its symmetry axis first
    result.moments = {own.y(), own.x(), own.z()};
  } else {
    result.kind = mesh;
    if (body.mass) {
      const scene::Inertia inertia = scene::inertia_of(triangles, *body.mass);
      result.offset = inertia.center;
      result.turn = inertia.axes;
      result.moments = inertia.moments;
    }
    for (const std::array<int, 3>& triangle : triangles.triangles)
      for (const int corner : triangle) {
        const Vector3d own = result.turn.conjugate() * (triangles.points[static_cast<std::size_t>(corner)] - result.offset);
        result.corners.push_back(own);
        result.size.head<3>() = result.size.head<3>().cwiseMax(own.cwiseAbs());
      }
  }
  return result;
}

class Placing final : public graph::HostStage {
 public:
  explicit Placing(std::shared_ptr<const Problem> problem) : problem_(std::move(problem)) {}

  void run(graph::HostContext& context) override {
    std::vector<std::int32_t> kind, path, facet_body, swept_facets;
    std::vector<float> size, position, orientation, velocity, spin, friction, mass, inertia, color, path_time, path_position,
        path_orientation, facet_points;
    const std::vector<scene::Body>& bodies = problem_->scene.bodies;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const scene::Body& body = bodies[b];
      const Placed own = placed(body, problem_->meshes[b]);
      const auto put_pose = [&](const Vector3d& place, const Quaterniond& turn, std::vector<float>& places,
                                std::vector<float>& turns) {
        put(places, place + turn * own.offset);
        put(turns, turn * own.turn);
      };
      kind.push_back(own.kind);
      put(size, {own.size[0], own.size[1], own.size[2], own.size[3]});
      if (body.path.empty())
        put_pose(body.position, body.orientation, position, orientation);
      else
        put_pose(body.path.front().position, body.path.front().orientation, position, orientation);
      put(velocity, body.velocity);
      put(spin, body.spin);
      put(friction, {body.friction});
      put(mass, {body.mass.value_or(0.0)});
      put(inertia, own.moments);
      put(color, body.color);
      path.push_back(static_cast<std::int32_t>(path_time.size()));
      path.push_back(static_cast<std::int32_t>(body.path.size()));
      for (const scene::KeyFrame& key : body.path) {
        put(path_time, {key.time});
        put_pose(key.position, key.orientation, path_position, path_orientation);
      }
      for (const Vector3d& corner : own.corners) put(facet_points, corner);
      const bool swept = facets_are_swept(body);
      for (std::size_t facet = 0; facet < own.corners.size() / 3; ++facet) {
        if (swept) swept_facets.push_back(static_cast<std::int32_t>(facet_body.size()));
        facet_body.push_back(static_cast<std::int32_t>(b));
      }
    }
    if (context.bound("body_distances")) write_distances(context);
    const std::pair<const char*, const std::vector<std::int32_t>*> integers[] = {
        {"body_kind", &kind}, {"body_path", &path}, {"facet_body", &facet_body}, {"swept_facets", &swept_facets}};
    for (const auto& [port, values] : integers)
      if (context.bound(port)) context.write_integers(port, *values);
    const std::pair<const char*, const std::vector<float>*> floats[] = {{"body_size", &size},
                                                                        {"body_position", &position},
                                                                        {"body_orientation", &orientation},
                                                                        {"body_position_before", &position},
                                                                        {"body_orientation_before", &orientation},
                                                                        {"body_velocity", &velocity},
                                                                        {"body_spin", &spin},
                                                                        {"body_friction", &friction},
                                                                        {"body_mass", &mass},
                                                                        {"body_inertia", &inertia},
                                                                        {"body_color", &color},
                                                                        {"path_time", &path_time},
                                                                        {"path_position", &path_position},
                                                                        {"path_orientation", &path_orientation},
                                                                        {"facet_points", &facet_points}};
    for (const auto& [port, values] : floats)
      if (context.bound(port)) context.write_floats(port, *values);
  }

 private:
  void write_distances(graph::HostContext& context) const {
    std::vector<float> values, boxes;
    std::vector<std::int32_t> nodes;
    const std::vector<std::optional<DistanceGrid>> grids = distance_grids(*problem_);
    for (std::size_t b = 0; b < grids.size(); ++b) {
      const DistanceGrid grid = grids[b].value_or(DistanceGrid{});
      put(boxes, {grid.min.x(), grid.min.y(), grid.min.z(), grid.cell});
      nodes.insert(nodes.end(), {grid.nodes.x(), grid.nodes.y(), grid.nodes.z(), static_cast<std::int32_t>(values.size())});
      if (!grids[b]) continue;
      const std::vector<float> own = distances(in_own_axes(problem_->scene.bodies[b], problem_->meshes[b]), grid);
      values.insert(values.end(), own.begin(), own.end());
    }
    context.write_floats("body_distances", values);
    context.write_floats("body_distance_box", boxes);
    context.write_integers("body_distance_nodes", nodes);
  }

  std::shared_ptr<const Problem> problem_;
};

}  // namespace

graph::StageSpec place() {
  graph::StageSpec spec{.name = "bodies.place",
                        .doc = "Puts the scene's rigid bodies where they start",
                        .equation = "",
                        .ports = {},
                        .work = {graph::HostWork{}}};
  const auto add = [&](graph::Port port, bool optional) {
    port.usage = Usage::host;
    port.optional = optional;
    spec.ports.push_back(port);
  };
  for (const char* name :
       {"body_kind", "body_size", "body_position", "body_orientation", "body_velocity", "body_spin", "body_mass", "body_path"})
    add(mpm::body(name, Access::write), false);
  for (const graph::Port& port : mpm::key_frames(Access::write)) add(port, false);
  for (const char* name : {"body_friction", "body_color", "body_inertia", "body_position_before", "body_orientation_before"})
    add(mpm::body(name, Access::write), true);
  for (const char* name : {"facet_points", "facet_body", "swept_facets"}) add(heightfield::port(name, Access::write), true);
  for (const graph::Port& port : mpm::body_distances(Access::write, Usage::host)) add(port, true);
  return spec;
}

graph::HostFactory placing(std::shared_ptr<const Problem> problem) {
  return [problem = std::move(problem)](const graph::ParameterValues&) { return std::make_unique<Placing>(problem); };
}

}  // namespace firn::stages::bodies
