#include "stages/mpm/emit.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>

#include "scene/emission.h"
#include "stages/mass_sums.h"
#include "stages/mpm_ports.h"

namespace firn::stages::mpm {
namespace {

class Emitting final : public graph::HostStage {
 public:
  explicit Emitting(std::shared_ptr<const Problem> problem) : problem_(std::move(problem)) {}

  void run(graph::HostContext& context) override {
    const scene::Scene& scene = problem_->scene;
    const double time = context.clock().time;
    if (!next_) next_ = context.read_integers("emitter_next");  // unsigned; nobody else writes it
    const std::uint64_t there = context.view("position").count;
    std::uint64_t room = scene.max_particles - std::min(scene.max_particles, there);
    std::optional<std::vector<double>> sums;
    scene::Particles particles;
    bool all_fit = true;
    for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
      const std::uint64_t first = static_cast<std::uint32_t>((*next_)[e]);
      const std::uint64_t due = std::max(first, scene::emitted_until(scene, scene.emitters[e], time));
      if (due == first) continue;
      const std::uint64_t taken = std::min(room, due - first);
      const scene::Particles more = scene::emitted(scene, e, first, first + taken, time);
      if (!sums) sums = read_mass_sums(context, "emitted_mass");
      for (const double mass : more.mass) (*sums)[e] += static_cast<double>(static_cast<float>(mass));
      append(particles, more);
      room -= taken;
      all_fit = all_fit && taken == due - first;
      (*next_)[e] = static_cast<std::int32_t>(static_cast<std::uint32_t>(due));
    }
    if (!sums) return;
    context.write_integers("emitter_next", *next_);
    write_mass_sums(context, "emitted_mass", *sums);
    if (!particles.mass.empty()) bring(particles, there, context);
    if (!all_fit && !told_)
      spdlog::warn(
          "at {:.4g} s there are {} particles, as many as max_particles of the scene allows: from now on emitters bring only "
          "as many as have gone",
          time, scene.max_particles);
    told_ |= !all_fit;
  }

 private:
  static void append(scene::Particles& all, const scene::Particles& more) {
    const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    add(all.position, more.position);
    add(all.velocity, more.velocity);
    add(all.mass, more.mass);
    add(all.volume, more.volume);
    add(all.material, more.material);
  }

  // Everything that is not written here begins with zeros, as stress does.
  static void bring(const scene::Particles& particles, std::uint64_t first, graph::HostContext& context) {
    const std::size_t count = particles.mass.size();
    context.append(count);
    const auto write = [&](std::string_view port, const auto& values) {
      context.write_from(port, first, graph::padded(context.view(port).type, std::as_bytes(std::span(values))));
    };
    const auto floats = [](const auto& vectors) {
      std::vector<float> values;
      for (const scene::Vector3d& v : vectors)
        for (const double part : v) values.push_back(static_cast<float>(part));
      return values;
    };
    std::vector<float> density, identity;
    for (std::size_t i = 0; i < count; ++i) {
      density.push_back(static_cast<float>(particles.mass[i] / particles.volume[i]));
      for (std::size_t entry = 0; entry < 9; ++entry) identity.push_back(entry % 4 == 0 ? 1.0F : 0.0F);
    }
    write("position", floats(particles.position));
    write("velocity", floats(particles.velocity));
    write("mass", std::vector<float>(particles.mass.begin(), particles.mass.end()));
    write("volume", std::vector<float>(particles.volume.begin(), particles.volume.end()));
    write("plastic_det", std::vector<float>(count, 1.0F));
    write("elastic", identity);
    write("material", std::vector<std::int32_t>(particles.material.begin(), particles.material.end()));
    if (context.bound("density")) write("density", density);
  }

  std::shared_ptr<const Problem> problem_;
  std::optional<std::vector<std::int32_t>> next_;  // by emitter: number of the next particle
  bool told_ = false;
};

}  // namespace

graph::StageSpec emit() {
  const auto access = Access::read_write;
  const auto host = Usage::host;
  Port density_of = density(access);
  density_of.usage = host;
  std::vector<Port> ports{position(access, host),
                          velocity(access, host),
                          mass(access, host),
                          volume(access, host),
                          elastic(access, host),
                          plastic_det(access, host),
                          material(access, host),
                          density_of,
                          {.name = "emitter_next",
                           .type = ElementType::uint1,
                           .domain = "emitters",
                           .access = access,
                           .usage = host,
                           .unit = "1",
                           .doc = "how many particles every emitter has had due, whether there was room for them or not"},
                          mass_sums("emitted_mass", "emitters", "mass of the particles that every emitter has brought")};
  for (Port& port : ports) port = when(port, "emitters", "some");
  return {
      .name = "mpm.emit",
      .doc =
          "Brings the particles that the scene's emitters have due since the last time, where they have flown to by now; without "
          "emitters nothing",
      .equation = "x = x0 + v0 t + g t^2 / 2",
      .ports = ports,
      .resizes = "particles",
      .work = {graph::HostWork{.when = {"emitters", "some"}}}};
}

graph::HostFactory emitting(std::shared_ptr<const Problem> problem) {
  return [problem = std::move(problem)](const graph::ParameterValues&) { return std::make_unique<Emitting>(problem); };
}

}  // namespace firn::stages::mpm
