#include "stages/mpm/seed.h"

#include "scene/materials.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {
namespace {

std::vector<float> floats(const std::vector<double>& values) { return {values.begin(), values.end()}; }

std::vector<float> floats(const std::vector<scene::Vector3d>& vectors) {
  std::vector<float> values;
  values.reserve(vectors.size() * 3);
  for (const scene::Vector3d& v : vectors)
    for (const double part : v) values.push_back(static_cast<float>(part));
  return values;
}

class Seeding final : public graph::HostStage {
 public:
  Seeding(std::shared_ptr<const Problem> problem, bool affine) : problem_(std::move(problem)), affine_(affine) {}

  void run(graph::HostContext& context) override {
    const scene::Particles& particles = problem_->particles;
    const std::size_t count = particles.position.size();
    if (count != context.view("position").count) {  // room for those that come later
      context.keep({});
      context.append(count);
    }
    context.write_floats("position", floats(particles.position));
    context.write_floats("velocity", floats(particles.velocity));
    context.write_floats("mass", floats(particles.mass));
    context.write_floats("volume", floats(particles.volume));
    context.write_floats("plastic_det", std::vector<float>(count, 1.0f));
    std::vector<float> identity(count * 9, 0.0f);
    for (std::size_t i = 0; i < identity.size(); ++i) identity[i] = i % 9 % 4 == 0 ? 1.0f : 0.0f;
    context.write_floats("elastic", identity);
    if (affine_) context.write_floats("velocity_gradient", std::vector<float>(count * 9, 0.0f));
    context.write_integers("material", std::vector<std::int32_t>(particles.material.begin(), particles.material.end()));

    std::vector<float> elastic, plastic;
    for (const scene::Material& material : problem_->scene.materials) {
      for (const double value : {scene::lame_mu(material), scene::lame_lambda(material), material.hardening, material.density})
        elastic.push_back(static_cast<float>(value));
      for (const double value : {material.critical_compression, material.critical_stretch})
        plastic.push_back(static_cast<float>(value));
    }
    context.write_floats("material_elastic", elastic);
    context.write_floats("material_plastic", plastic);
  }

 private:
  std::shared_ptr<const Problem> problem_;
  bool affine_;
};

}  // namespace

graph::StageSpec seed() {
  const auto w = Access::write;
  const auto host = Usage::host;
  return {.name = "mpm.seed",
          .doc = "Fills the scene's snow with particles at rest in themselves (FE = 1, J_P = 1), and lists its materials",
          .equation = "",
          .ports = {position(w, host), velocity(w, host), mass(w, host), volume(w, host), elastic(w, host), plastic_det(w, host),
                    material(w, host), material_elastic(w, host), material_plastic(w, host),
                    when(velocity_gradient(w, host), "affine", "zero")},
          .parameters = {{.name = "affine",
                          .kind = graph::ParameterKind::choice,
                          .initial = std::string("none"),
                          .choices = {"none", "zero"},
                          .doc = "zero: particles start without affine part, for mpm.gather_affine; none: not written"}},
          .resizes = "particles",
          .work = {graph::HostWork{}}};
}

graph::HostFactory seeding(std::shared_ptr<const Problem> problem) {
  return [problem = std::move(problem)](const graph::ParameterValues& values) {
    return std::make_unique<Seeding>(problem, std::get<std::string>(values.at("affine")) == "zero");
  };
}

}  // namespace firn::stages::mpm
