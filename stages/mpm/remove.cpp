#include "stages/mpm/remove.h"

#include <algorithm>

#include "stages/mass_sums.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {
namespace {

bool lies_in(const scene::Box& box, const float* position) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(static_cast<double>(position[axis]) - box.center[axis]) <= box.half_size[axis])) return false;
  return true;
}

class Removing final : public graph::HostStage {
 public:
  explicit Removing(std::shared_ptr<const Problem> problem) : problem_(std::move(problem)) {}

  void run(graph::HostContext& context) override {
    const std::vector<scene::Sink>& sinks = problem_->scene.sinks;
    const double time = context.clock().time;
    const auto is_on = [&](const scene::Sink& sink) { return sink.span.from <= time && time < sink.span.until; };
    if (std::ranges::none_of(sinks, is_on)) return;
    const std::vector<float> position = context.read_floats("position");
    const std::size_t count = position.size() / 3;
    std::vector<std::uint32_t> kept;
    std::vector<std::pair<std::size_t, std::size_t>> gone;  // particle, sink
    for (std::size_t p = 0; p < count; ++p) {
      const auto sink =
          std::ranges::find_if(sinks, [&](const scene::Sink& each) { return is_on(each) && lies_in(each.box, &position[3 * p]); });
      if (sink == sinks.end())
        kept.push_back(static_cast<std::uint32_t>(p));
      else
        gone.emplace_back(p, sink - sinks.begin());
    }
    if (gone.empty()) return;
    const std::vector<float> mass = context.read_floats("mass");
    std::vector<double> sums = read_mass_sums(context, "removed_mass");
    for (const auto& [particle, sink] : gone) sums[sink] += static_cast<double>(mass[particle]);
    write_mass_sums(context, "removed_mass", sums);
    context.keep(kept);
  }

 private:
  std::shared_ptr<const Problem> problem_;
};

}  // namespace

graph::StageSpec remove() {
  std::vector<Port> ports{position(Access::read, Usage::host), mass(Access::read, Usage::host),
                          mass_sums("removed_mass", "sinks", "mass of the particles that every sink has taken away")};
  for (Port& port : ports) port = when(port, "sinks", "some");
  return {.name = "mpm.remove",
          .doc = "Takes away the particles that lie in one of the scene's sinks; without sinks nothing",
          .equation = "",
          .ports = ports,
          .resizes = "particles",
          .work = {graph::HostWork{.when = {"sinks", "some"}}}};
}

graph::HostFactory removing(std::shared_ptr<const Problem> problem) {
  return [problem = std::move(problem)](const graph::ParameterValues&) { return std::make_unique<Removing>(problem); };
}

}  // namespace firn::stages::mpm
