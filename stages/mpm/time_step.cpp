#include "stages/mpm/time_step.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "stages/mpm_ports.h"

namespace firn::stages::mpm {
namespace {

class TimeStepping final : public graph::HostStage {
 public:
  explicit TimeStepping(std::shared_ptr<const Problem> problem) : problem_(std::move(problem)) {}

  void run(graph::HostContext& context) override {
    float number = 0;
    context.read_into("fastest", std::as_writable_bytes(std::span(&number, 1)));
    const double fastest = number;
    if (!(fastest > 0) || !std::isfinite(fastest))
      return;  // nothing moves; what is not a number is told by the stages that meet it
    const double limit = problem_->scene.time.cfl * problem_->scene.domain->cell / fastest;
    // The rest of the frame in equal parts, so that no tiny step remains.
    const double asked = context.clock().dt;
    context.set_time_step(asked / std::max(1.0, std::ceil(asked / limit)));
  }

 private:
  std::shared_ptr<const Problem> problem_;
};

}  // namespace

graph::StageSpec time_step() {
  using enum Access;
  const graph::Condition automatic{"time_step", "auto"};
  const Port fastest{.name = "fastest",
                     .type = ElementType::uint1,
                     .domain = "1",
                     .access = read_write,
                     .unit = "m/s",
                     .doc = "largest speed of a particle and its pressure waves, as the bits of a float",
                     .when = automatic};
  const auto only = [&](Port port) {
    port.when = automatic;
    return port;
  };
  return {
      .name = "mpm.time_step",
      .doc =
          "With `dt: auto` in the scene: the length of the step by the CFL condition on particle speed and speed of sound; else "
          "nothing",
      .equation = "dt <= cfl h / (|v| + sqrt((lambda + 2 mu) / rho))",
      .ports = {only(velocity(read)), only(plastic_det(read)), only(material(read)), only(material_elastic(read)), fastest},
      .sets_time_step = true,
      .work = {graph::Dispatch{.kernel = "mpm/time_step_begin.comp", .over = "1", .uses = {{"fastest", write}}, .when = automatic},
               graph::Dispatch{.kernel = "mpm/time_step.comp",
                               .over = "particles",
                               .uses = {{"velocity", read},
                                        {"plastic_det", read},
                                        {"material", read},
                                        {"material_elastic", read},
                                        {"fastest", accumulate}},
                               .when = automatic},
               graph::HostWork{.uses = {{"fastest", read, Usage::host}}, .when = automatic}}};
}

graph::HostFactory time_stepping(std::shared_ptr<const Problem> problem) {
  return [problem = std::move(problem)](const graph::ParameterValues&) { return std::make_unique<TimeStepping>(problem); };
}

}  // namespace firn::stages::mpm
