#include "stages/heightfield/init.h"

#include "scene/field.h"
#include "stages/heightfield_ports.h"

namespace firn::stages::heightfield {
namespace {

class Initialising final : public graph::HostStage {
 public:
  explicit Initialising(std::shared_ptr<const Problem> problem) : problem_(std::move(problem)) {}

  void run(graph::HostContext& context) override {
    const scene::FieldArrays field = scene::sample_field(problem_->scene);
    context.write_floats("ground", field.ground);
    context.write_floats("depth", field.depth);
    context.write_floats("density", field.density);
    if (context.bound("changed_tiles"))
      context.write_integers("changed_tiles", std::vector<std::int32_t>(context.view("changed_tiles").count, 1));
  }

 private:
  std::shared_ptr<const Problem> problem_;
};

}  // namespace

graph::StageSpec init() {
  Port changed = optional("changed_tiles", Access::write);
  changed.usage = Usage::host;
  return {.name = "heightfield.init",
          .doc = "Lays the scene's field: ground, snow and its density",
          .equation = "[H 3.1]",
          .ports = {port("ground", Access::write, Usage::host), port("depth", Access::write, Usage::host),
                    port("density", Access::write, Usage::host), changed},
          .work = {graph::HostWork{}}};
}

graph::HostFactory initialising(std::shared_ptr<const Problem> problem) {
  return [problem = std::move(problem)](const graph::ParameterValues&) { return std::make_unique<Initialising>(problem); };
}

}  // namespace firn::stages::heightfield
