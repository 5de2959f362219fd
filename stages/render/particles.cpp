#include "stages/render/particles.h"

#include "stages/mpm_ports.h"
#include "stages/view_ports.h"

namespace firn::stages::render {
namespace {

using graph::ElementType;
using graph::ParameterKind;
using graph::ParameterSpec;
using graph::Port;
using graph::Usage;

class Coloring final : public graph::HostStage {
 public:
  explicit Coloring(std::shared_ptr<const Problem> problem) : problem_(std::move(problem)) {}

  void run(graph::HostContext& context) override {
    std::vector<float> look;
    for (const scene::Material& material : problem_->scene.materials)
      for (const double part : {material.color.x(), material.color.y(), material.color.z(), material.density})
        look.push_back(static_cast<float>(part));
    context.write_floats("material_look", look);
  }

 private:
  std::shared_ptr<const Problem> problem_;
};

std::vector<ParameterSpec> parameters() {
  return {view::exposure_parameter(),
          mpm::nodes_parameter(),
          {.name = "detail",
           .kind = ParameterKind::choice,
           .initial = std::string("grains"),
           .choices = {"spheres", "grains"},
           .doc = "what a particle looks like: one ball, or up to 27 grains that move with it, as the picture can show them"},
          {.name = "radius",
           .kind = ParameterKind::number,
           .initial = 0.62,
           .min = 0.05,
           .max = 5.0,
           .unit = "1",
           .doc = "of the ball that a particle fills, in cube roots of its volume"},
          {.name = "color_by",
           .kind = ParameterKind::choice,
           .initial = std::string("material"),
           .choices = {"material", "speed", "compression"},
           .doc = "the material's own colour, or a scale from blue (slow, loose) to red (fast, compressed)"},
          {.name = "speed_range",
           .kind = ParameterKind::number,
           .initial = 5.0,
           .min = 1.0e-3,
           .max = 1.0e4,
           .unit = "m/s",
           .doc = "speed at the red end of the scale"},
          {.name = "compression_range",
           .kind = ParameterKind::number,
           .initial = 0.2,
           .min = 1.0e-4,
           .max = 1.0,
           .unit = "1",
           .doc = "1 - J_P at the red end of the scale, and where snow looks icy"}};
}

// The mass of nodes, where the pipeline has a grid, and where nodes are stored.
std::vector<Port> masses() {
  std::vector<Port> ports = mpm::joined({mpm::by_nodes(mpm::grid_mass, graph::Access::read, Usage::sampled), mpm::stencil_ports()});
  for (Port& port : ports) port = mpm::optional(port);
  return ports;
}

}  // namespace

// A kernel finds what light there is at every particle; the draw gives it to grains.
graph::StageSpec particles() {
  using enum graph::Access;
  const auto own = [](const char* name, const char* doc, ElementType type = ElementType::vec4) {
    return Port{.name = name, .type = type, .domain = "particles", .access = read_write, .unit = "mixed", .doc = doc};
  };
  const Port look{.name = "material_look",
                  .type = ElementType::vec4,
                  .domain = "materials",
                  .access = read_write,
                  .usage = Usage::sampled,
                  .unit = "1, 1, 1, kg/m3",
                  .doc = "colour (sRGB) and density of materials"};
  std::vector<graph::PortUse> of_light =
      view::sampled({"position", "material", "plastic_det", "velocity", "material_look", "grid_mass", "shadow_map", "body_kind",
                     "body_size", "body_position", "body_orientation"});
  for (const char* name : {"particle_cell", "block_slot", "block_near"}) of_light.push_back({name, read, Usage::storage});
  of_light.push_back({"particle_surface", write, Usage::storage});
  of_light.push_back({"particle_color", write, Usage::storage});
  of_light.push_back({"particle_shown", write, Usage::storage});
  const auto draw = [](const char* detail, const char* vertices) {
    return graph::Draw{.name = detail,
                       .vertex = "render/particles.vert",
                       .fragment = "render/particles.frag",
                       .colors = {"image"},
                       .depth = "image_depth",
                       .vertices = vertices,
                       .uses = view::sampled({"position", "volume", "particle_surface", "particle_color", "particle_shown"}),
                       .when = {"detail", detail}};
  };
  std::vector<std::string> constants = view::constants();
  for (const char* name : {"grid_min", "grid_cell", "grid_nodes"}) constants.emplace_back(name);
  return {
      .name = "render.particles",
      .doc = "Particles as grains of snow, in sun and sky light",
      .equation = "",
      .ports = mpm::joined(
          {{view::image(read_write, Usage::framebuffer), view::image_depth(read_write), mpm::position(read, Usage::sampled),
            mpm::volume(read, Usage::sampled), mpm::material(read, Usage::sampled), view::optional(mpm::plastic_det(read)),
            view::optional(mpm::velocity(read)), view::optional_shadow_map(), look,
            own("particle_surface", "outward normal of the snow about particles, 0 inside; share of the sun that arrives"),
            own("particle_color", "linear colour of particles; share of the sky that they see"),
            own("particle_shown", "share of its grains that a particle shows: none but the core inside snow", ElementType::float1)},
           masses(),
           view::optional_shapes()}),
      .parameters = parameters(),
      .constants = constants,
      .work = {graph::HostWork{.uses = {{"material_look", write, Usage::host}}},
               graph::Dispatch{.kernel = "render/particle_light.comp", .over = "particles", .uses = of_light},
               draw("spheres", "particles*3"), draw("grains", "particles*81")}};
}

graph::HostFactory coloring(std::shared_ptr<const Problem> problem) {
  return [problem = std::move(problem)](const graph::ParameterValues&) { return std::make_unique<Coloring>(problem); };
}

}  // namespace firn::stages::render
