#pragma once

// Random plans without barriers, of commands that OpenGL allows; some buffers share memory, some repeats end on the device.

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "graph/plan.h"
#include "graph/repeats.h"

namespace firn::test {

class RandomPlan {
 public:
  explicit RandomPlan(std::uint64_t seed) : random_(seed) {}

  graph::Plan plan() {
    const int buffers = 1 + below(4);
    for (int b = 0; b < buffers; ++b) {
      graph::PlannedBuffer& buffer = plan_.buffers.emplace_back();
      buffer.texture = below(3) == 0;
      buffer.storage = b;
      if (!buffer.texture && b > 0 && below(4) == 0)
        if (const graph::PlannedBuffer& other = plan_.buffers[static_cast<std::size_t>(below(b))]; !other.texture)
          buffer.storage = other.storage;
      buffer.name = (buffer.texture ? "image" : "buffer") + std::to_string(b);
    }
    plan_.setup = ops(below(4), 0);
    plan_.step = ops(below(7), 0);
    plan_.frame = ops(below(4), 0);
    if (below(2) == 0) graph::decide_on_device(plan_);
    return std::move(plan_);
  }

 private:
  using Way = std::pair<graph::Access, graph::Usage>;

  int below(int limit) { return std::uniform_int_distribution<int>(0, limit - 1)(random_); }

  Way way(bool texture) {
    using enum graph::Access;
    using enum graph::Usage;
    // Stores and loads by shaders stand more often than the rest: they are what hazards are made of.
    static const std::vector<Way> of_buffers{
        {read, storage},       {read, storage}, {write, storage}, {write, storage},  {read_write, storage}, {accumulate, storage},
        {accumulate, storage}, {read, uniform}, {read, sampled},  {read, vertex},    {read, indirect},      {read, transfer},
        {write, transfer},     {read, host},    {write, host},    {read_write, host}};
    static const std::vector<Way> of_textures{
        {read, image},   {write, image},  {write, image},       {read_write, image},       {accumulate, image},
        {read, sampled}, {read, sampled}, {write, framebuffer}, {read_write, framebuffer}, {read, framebuffer},
        {read, host},    {write, host},   {read, transfer}};
    const std::vector<Way>& ways = texture ? of_textures : of_buffers;
    return ways[static_cast<std::size_t>(below(static_cast<int>(ways.size())))];
  }

  graph::Run run() {
    // Some stages have several pieces of work.
    if (plan_.stages.empty() || below(4) != 0) {
      graph::PlannedStage& stage = plan_.stages.emplace_back();
      stage.label = "stage" + std::to_string(plan_.stages.size());
      stage.spec.work = {graph::Dispatch{.kernel = "random.comp", .over = "100"}};
      if (below(4) == 0) stage.every = 2 + below(2);
    }
    graph::Run command;
    command.stage = static_cast<int>(plan_.stages.size()) - 1;
    for (int b = 0; b < static_cast<int>(plan_.buffers.size()); ++b) {
      if (below(2) == 0) continue;
      const auto [access, usage] = way(plan_.buffers[static_cast<std::size_t>(b)].texture);
      command.accesses.push_back({b, access, usage});
    }
    return command;
  }

  std::vector<graph::Op> ops(int count, int depth) {
    std::vector<graph::Op> list;
    for (int i = 0; i < count; ++i) {
      if (depth < 2 && below(5) == 0 && repeats_ < 4) {
        ++repeats_;
        graph::Repeat repeat;
        repeat.max = 1 + below(4);
        if (below(2) == 0) {
          const int watched = below(static_cast<int>(plan_.buffers.size()));
          if (!plan_.buffers[static_cast<std::size_t>(watched)].texture) repeat.until = graph::PlannedUntil{watched, 0.5, -1};
        }
        repeat.body = ops(1 + below(3), depth + 1);
        list.emplace_back().what = repeat;
      } else {
        list.emplace_back().what = run();
      }
    }
    return list;
  }

  std::mt19937_64 random_;
  graph::Plan plan_;
  int repeats_ = 0;
};

}  // namespace firn::test
