#include "stages/render/surface.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "stages/mpm_ports.h"
#include "stages/snow_surface.h"
#include "stages/vdb_files.h"
#include "stages/view_ports.h"

namespace firn::stages::render {
namespace {

using enum graph::Access;
using graph::ElementType;
using graph::Port;
using graph::Usage;

float linear(double srgb) { return static_cast<float>(srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4)); }

class Meshing final : public graph::HostStage {
 public:
  Meshing(std::shared_ptr<const Problem> problem, const graph::ParameterValues& parameters)
      : problem_(std::move(problem)), shape_(surface_shape(parameters)) {
    if (!has_openvdb()) static_cast<void>(snow_surface({}, shape_));
    for (const scene::Material& material : problem_->scene.materials)
      colors_.push_back({linear(material.color.x()), linear(material.color.y()), linear(material.color.z())});
  }

  void run(graph::HostContext& context) override {
    std::vector<float> colors;
    for (const std::int32_t material : context.read_integers("material")) {
      const std::array<float, 3>& color = colors_.at(static_cast<std::size_t>(material));
      colors.insert(colors.end(), color.begin(), color.end());
    }
    const NodeField share =
        share_of_snow(context.read_floats("position"), context.read_floats("volume"), colors, *problem_->scene.domain, shape_);
    const scene::TriangleMesh mesh = snow_surface(share, shape_);
    const auto fits = [&](const char* what, const char* port, std::size_t count) {
      if (const std::uint64_t room = context.view(port).count; count > room)
        throw std::runtime_error(fmt::format(
            "render.surface: the surface of the snow has {} {} in frame {}, but there is room for {}; a larger 'cell', a "
            "higher 'level' or more 'smoothing' makes fewer",
            count, what, context.clock().frame, room));
    };
    fits("corners", "surface_corner", mesh.points.size());
    fits("triangles", "surface_triangle", mesh.triangles.size());
    std::vector<std::array<float, 3>> points;
    for (const scene::Vector3d& p : mesh.points)
      points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    write(context, "surface_corner", points);
    write(context, "surface_normal", outward_normals(mesh));
    write(context, "surface_color", velocity_at(share, mesh.points));
    std::vector<std::int32_t> corners;
    for (const std::array<int, 3>& triangle : mesh.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
    corners.resize(context.view("surface_triangle").count * 3);  // what is left is triangles without area: three times corner 0
    context.write_integers("surface_triangle", corners);
  }

 private:
  static void write(graph::HostContext& context, const char* port, const std::vector<std::array<float, 3>>& vectors) {
    std::vector<float> values;
    values.reserve(context.view(port).count * 3);
    for (const std::array<float, 3>& v : vectors) values.insert(values.end(), v.begin(), v.end());
    values.resize(context.view(port).count * 3);
    context.write_floats(port, values);
  }

  std::shared_ptr<const Problem> problem_;
  SurfaceShape shape_;
  std::vector<std::array<float, 3>> colors_;  // linear, of materials
};

}  // namespace

// The host makes the mesh, a kernel finds the light at its corners, the draw fills its triangles.
graph::StageSpec surface() {
  const auto own = [](const char* name, ElementType type, const char* domain, const char* unit, const char* doc) {
    return Port{
        .name = name, .type = type, .domain = domain, .access = read_write, .usage = Usage::sampled, .unit = unit, .doc = doc};
  };
  std::vector<graph::PortUse> of_mesh{{"position", read}, {"volume", read}, {"material", read}};
  for (const char* name : {"surface_corner", "surface_normal", "surface_color", "surface_triangle"})
    of_mesh.push_back({name, write, Usage::host});
  std::vector<graph::PortUse> of_light = view::sampled(
      {"surface_corner", "surface_normal", "shadow_map", "body_kind", "body_size", "body_position", "body_orientation"});
  of_light.push_back({"surface_light", write, Usage::storage});
  std::vector<graph::ParameterSpec> parameters = surface_parameters(0.25);  // so low that loose snow is seen too
  parameters.push_back(view::exposure_parameter());
  std::vector<std::string> constants = view::constants();
  constants.emplace_back("grid_cell");
  return {
      .name = "render.surface",
      .doc = "Snow as one closed surface round its particles, in sun and sky light",
      .equation = "",
      .ports = mpm::joined(
          {{view::image(read_write, Usage::framebuffer), view::image_depth(read_write), mpm::position(read, Usage::host),
            mpm::volume(read, Usage::host), mpm::material(read, Usage::host), view::optional_shadow_map(),
            own("surface_corner", ElementType::vec3, "surface_corners", "m", "corners of the snow's surface"),
            own("surface_normal", ElementType::vec3, "surface_corners", "1", "outward unit vectors there"),
            own("surface_color", ElementType::vec3, "surface_corners", "1", "linear colour there, the mean of the materials about"),
            own("surface_light", ElementType::vec2, "surface_corners", "1",
                "shares of the sun that arrives there, and of the sky that is seen"),
            own("surface_triangle", ElementType::ivec3, "surface_corners*2", "1",
                "corners of triangles; three times the same in those that are not used")},
           view::optional_shapes()}),
      .parameters = parameters,
      .constants = constants,
      .work = {graph::HostWork{.uses = of_mesh},
               graph::Dispatch{.kernel = "render/surface_light.comp", .over = "surface_corners", .uses = of_light},
               graph::Draw{.name = "surface",
                           .vertex = "render/surface.vert",
                           .fragment = "render/surface.frag",
                           .colors = {"image"},
                           .depth = "image_depth",
                           .vertices = "surface_corners*6",
                           .uses = view::sampled(
                               {"surface_corner", "surface_normal", "surface_color", "surface_light", "surface_triangle"})}}};
}

graph::HostFactory meshing(std::shared_ptr<const Problem> problem) {
  return [problem = std::move(problem)](const graph::ParameterValues& parameters) {
    return std::make_unique<Meshing>(problem, parameters);
  };
}

}  // namespace firn::stages::render
