#include "stages/bodies/place.h"

#include "stages/mpm_ports.h"

namespace firn::stages::bodies {
namespace {

using graph::Access;
using graph::Usage;

enum Kind : std::int32_t { half_space = 0, sphere = 1, box = 2, capsule = 3 };  // as shaders/lib/bodies.glsl has it

void put(std::vector<float>& values, std::initializer_list<double> parts) {
  for (const double part : parts) values.push_back(static_cast<float>(part));
}
void put(std::vector<float>& values, const scene::Vector3d& v) { put(values, {v.x(), v.y(), v.z()}); }
void put(std::vector<float>& values, const scene::Quaterniond& q) { put(values, {q.x(), q.y(), q.z(), q.w()}); }

// A body as the GPU wants it: every shape about its own origin, its axis along local y.
struct Placed {
  Kind kind = sphere;
  Eigen::Vector4d size{0, 0, 0, 0};
  scene::Vector3d position{0, 0, 0};
  scene::Quaterniond orientation = scene::Quaterniond::Identity();
};

Placed placed(const scene::Body& body) {
  Placed result;
  result.position = body.position;
  result.orientation = body.orientation;
  const scene::Vector3d up = scene::Vector3d::UnitY();
  if (const auto* plane = std::get_if<scene::Plane>(&body.shape)) {
    result.kind = half_space;
    result.position = body.position + body.orientation * plane->point;
    result.orientation = body.orientation * scene::Quaterniond::FromTwoVectors(up, plane->normal);
  } else if (const auto* ball = std::get_if<scene::Sphere>(&body.shape)) {
    result.kind = sphere;
    result.size.x() = ball->radius;
    result.position = body.position + body.orientation * ball->center;
  } else if (const auto* block = std::get_if<scene::Box>(&body.shape)) {
    result.kind = box;
    result.size.head<3>() = block->half_size;
    result.position = body.position + body.orientation * block->center;
  } else if (const auto* rod = std::get_if<scene::Capsule>(&body.shape)) {
    result.kind = capsule;
    const scene::Vector3d axis = rod->end - rod->start;
    result.size.head<2>() = Eigen::Vector2d(rod->radius, 0.5 * axis.norm());
    result.position = body.position + body.orientation * (0.5 * (rod->start + rod->end));
    if (axis.norm() > 0) result.orientation = body.orientation * scene::Quaterniond::FromTwoVectors(up, axis);
  } else {
    config::Diagnostics diagnostics;
    diagnostics.error(body.place, "a mesh cannot be a collider of particles yet; use a plane, sphere, box or capsule");
    throw config::InputError(diagnostics);
  }
  return result;
}

class Placing final : public graph::HostStage {
 public:
  explicit Placing(std::shared_ptr<const Problem> problem) : problem_(std::move(problem)) {}

  void run(graph::HostContext& context) override {
    std::vector<std::int32_t> kind, path;
    std::vector<float> size, position, orientation, velocity, spin, friction, mass, color, path_time, path_position,
        path_orientation;
    for (const scene::Body& body : problem_->scene.bodies) {
      const Placed at = placed(body);
      // The shape's own offset and turn, which key frames have on top.
      const scene::Quaterniond own_turn = body.orientation.conjugate() * at.orientation;
      const scene::Vector3d own_offset = body.orientation.conjugate() * (at.position - body.position);
      kind.push_back(at.kind);
      put(size, {at.size[0], at.size[1], at.size[2], at.size[3]});
      put(position, body.path.empty() ? at.position : body.path.front().position + body.path.front().orientation * own_offset);
      put(orientation, body.path.empty() ? at.orientation : body.path.front().orientation * own_turn);
      put(velocity, body.velocity);
      put(spin, body.spin);
      put(friction, {body.friction});
      put(mass, {body.mass.value_or(0.0)});
      put(color, body.color);
      path.push_back(static_cast<std::int32_t>(path_time.size()));
      path.push_back(static_cast<std::int32_t>(body.path.size()));
      for (const scene::KeyFrame& key : body.path) {
        put(path_time, {key.time});
        put(path_position, key.position + key.orientation * own_offset);
        put(path_orientation, key.orientation * own_turn);
      }
    }
    context.write_integers("body_kind", kind);
    context.write_integers("body_path", path);
    const std::pair<const char*, const std::vector<float>*> fields[] = {{"body_size", &size},
                                                                        {"body_position", &position},
                                                                        {"body_orientation", &orientation},
                                                                        {"body_velocity", &velocity},
                                                                        {"body_spin", &spin},
                                                                        {"body_friction", &friction},
                                                                        {"body_mass", &mass},
                                                                        {"body_color", &color},
                                                                        {"path_time", &path_time},
                                                                        {"path_position", &path_position},
                                                                        {"path_orientation", &path_orientation}};
    for (const auto& [port, values] : fields) context.write_floats(port, *values);
  }

 private:
  std::shared_ptr<const Problem> problem_;
};

}  // namespace

graph::StageSpec place() {
  graph::StageSpec spec{.name = "bodies.place",
                        .doc = "Puts the scene's rigid bodies where they start",
                        .equation = "",
                        .ports = {},
                        .work = {graph::HostWork{}}};
  for (const char* name : {"body_kind", "body_size", "body_position", "body_orientation", "body_velocity", "body_spin",
                           "body_friction", "body_mass", "body_path", "body_color"})
    spec.ports.push_back(mpm::body(name, Access::write, Usage::host));
  for (graph::Port port : mpm::key_frames(Access::write)) {
    port.usage = Usage::host;
    spec.ports.push_back(port);
  }
  return spec;
}

graph::HostFactory placing(std::shared_ptr<const Problem> problem) {
  return [problem = std::move(problem)](const graph::ParameterValues&) { return std::make_unique<Placing>(problem); };
}

}  // namespace firn::stages::bodies
