#pragma once

// What a host stage sees of the plan that is being executed.

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "graph/execution/sizes.h"

namespace firn::execution {

class PlanContext final : public graph::HostContext {
 public:
  PlanContext(const graph::PlannedStage& stage, const graph::Plan& plan, Memory& memory, Sizes& sizes, graph::Clock& clock)
      : stage_(stage), plan_(plan), memory_(memory), sizes_(sizes), clock_(clock) {}

  [[nodiscard]] graph::PortView view(std::string_view port) const override {
    const graph::PlannedBuffer& buffer = plan_.buffers[index(port)];
    return {buffer.type, buffer.count, buffer.width, buffer.height};
  }
  [[nodiscard]] bool bound(std::string_view port) const override {
    return std::ranges::any_of(stage_.spec.ports, [&](const graph::Port& p) {
      return p.name == port && stage_.buffers[static_cast<std::size_t>(&p - stage_.spec.ports.data())] >= 0;
    });
  }
  std::vector<std::byte> read(std::string_view port) override {
    const std::size_t b = index(port);
    if (plan_.buffers[b].texture) return memory_.textures[b].download();
    std::vector<std::byte> data(plan_.buffers[b].bytes);
    memory_.buffer(static_cast<int>(b)).download(0, data);
    return data;
  }
  void read_into(std::string_view port, std::span<std::byte> data) override {
    const std::size_t b = index(port);
    if (plan_.buffers[b].texture || data.size() != plan_.buffers[b].bytes)
      throw std::logic_error(fmt::format("{}: reads {} bytes of '{}', which has {}{}", stage_.label, data.size(), port,
                                         plan_.buffers[b].bytes, plan_.buffers[b].texture ? ", as a picture" : ""));
    memory_.buffer(static_cast<int>(b)).download(0, data);
  }
  void write(std::string_view port, std::span<const std::byte> data) override {
    const std::size_t b = index(port);
    if (data.size() != plan_.buffers[b].bytes)
      throw std::logic_error(
          fmt::format("{}: writes {} bytes to '{}', which has {}", stage_.label, data.size(), port, plan_.buffers[b].bytes));
    if (plan_.buffers[b].texture)
      memory_.textures[b].upload(data);
    else if (!data.empty())
      memory_.buffer(static_cast<int>(b)).upload(0, data);
  }
  [[nodiscard]] const graph::Clock& clock() const override { return clock_; }
  void set_time_step(double dt) override {
    if (!stage_.spec.sets_time_step)
      throw std::logic_error(fmt::format("{} sets the time step, but does not say so", stage_.label));
    clock_.dt = dt;
  }
  void keep(std::span<const std::uint32_t> elements) override { sizes_.keep(resized(), elements); }
  void append(std::uint64_t count) override { sizes_.append(resized(), count); }
  void write_from(std::string_view port, std::uint64_t first, std::span<const std::byte> data) override {
    const std::size_t b = index(port);
    const std::uint64_t offset = first * graph::stride(plan_.buffers[b].type);
    if (plan_.buffers[b].texture || offset + data.size() > plan_.buffers[b].bytes)
      throw std::logic_error(fmt::format("{}: writes beyond the end of '{}'", stage_.label, port));
    if (!data.empty()) memory_.buffer(static_cast<int>(b)).upload(offset, data);
  }

 private:
  [[nodiscard]] const std::string& resized() const {
    if (stage_.spec.resizes.empty())
      throw std::logic_error(fmt::format("{} makes elements come and go, but does not say so", stage_.label));
    return stage_.spec.resizes;
  }
  [[nodiscard]] std::size_t index(std::string_view port) const {
    for (std::size_t p = 0; p < stage_.spec.ports.size(); ++p)
      if (stage_.spec.ports[p].name == port && stage_.buffers[p] >= 0) return static_cast<std::size_t>(stage_.buffers[p]);
    throw std::logic_error(fmt::format("{} has no bound port '{}'", stage_.label, port));
  }

  const graph::PlannedStage& stage_;
  const graph::Plan& plan_;
  Memory& memory_;
  Sizes& sizes_;
  graph::Clock& clock_;
};

}  // namespace firn::execution
