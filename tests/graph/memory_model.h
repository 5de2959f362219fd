#pragma once

// OpenGL's rules for memory that shaders write (OpenGL 4.3, 7.12.2), as a model that plans are held against. It knows nothing of
// how barriers are placed: it plays one execution event by event, remembers every access and every barrier with its time, and
// compares each access with all earlier ones.
//
// The rules:
//   1. An access sees an earlier shader store only if a barrier between the two names the access's way of looking at memory.
//   2. A shader store (by storage block or image) may overtake earlier accesses of any kind that OpenGL still executes: loads,
//   stores,
//      fetches, framebuffer reads and writes. A barrier with the store's own bit holds it back.
//   3. Atomic additions commute, so those of two commands need no order between them.
//   4. Commands of the API and framebuffer writes are ordered by OpenGL; what the API read is in the host's memory when the call
//   returns.

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "graph/plan.h"

namespace firn::test {

// What a plan leaves open in one execution.
struct Choices {
  std::function<std::int64_t(const graph::Repeat&)> turns;
  std::function<bool(int stage)> runs;  // asked once per phase and stage: stages with `every` are left out at times
};

// One event: a barrier, or a command with its accesses. Barriers are looked at when the trace is replayed, so they may change in
// between.
struct Event {
  const graph::Barrier* barrier = nullptr;
  int stage = -1;  // -1: the host reads the value that ends a repeat
  std::vector<graph::BufferAccess> accesses;
};
using Trace = std::vector<Event>;

enum class HazardKind { read_after_write, write_after_read, write_after_write };
struct Hazard {
  HazardKind kind;
  int buffer, earlier, later;  // earlier, later: stages
  graph::Bits bit;             // that a barrier between the two ought to have
};

namespace detail {

inline void trace_ops(const std::vector<graph::Op>& ops, const Choices& choices, std::vector<int>& runs, Trace& trace) {
  for (const graph::Op& op : ops) {
    if (const auto* barrier = std::get_if<graph::Barrier>(&op.what)) trace.push_back({barrier, -1, {}});
    if (const auto* run = std::get_if<graph::Run>(&op.what)) {
      int& decided = runs[static_cast<std::size_t>(run->stage)];
      if (decided < 0) decided = choices.runs(run->stage) ? 1 : 0;
      if (decided == 1) trace.push_back({nullptr, run->stage, run->accesses});
    }
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) {
      const std::int64_t turns = choices.turns(*repeat);
      for (std::int64_t turn = 0; turn < turns; ++turn) {
        trace_ops(repeat->body, choices, runs, trace);
        if (repeat->until && repeat->until->progress < 0)
          trace.push_back({nullptr, -1, {{repeat->until->buffer, graph::Access::read, graph::Usage::transfer}}});
      }
    }
  }
}

}  // namespace detail

// The setup, then `phases`: 's' a step, 'f' a frame.
inline Trace trace(const graph::Plan& plan, const std::string& phases, const Choices& choices) {
  Trace events;
  const auto play = [&](const std::vector<graph::Op>& ops) {
    std::vector<int> runs(plan.stages.size(), -1);
    detail::trace_ops(ops, choices, runs, events);
  };
  play(plan.setup);
  for (const char phase : phases) play(phase == 's' ? plan.step : plan.frame);
  return events;
}

class MemoryModel {
 public:
  explicit MemoryModel(const graph::Plan& plan) : plan_(plan), accesses_(plan.buffers.size()) {}

  // The first hazard of each access; stops at the first at all where `only_first`.
  std::vector<Hazard> hazards(const Trace& events, bool only_first) {
    for (auto& list : accesses_) list.clear();
    for (auto& list : barriers_) list.clear();
    std::vector<Hazard> found;
    int now = 0;
    for (const Event& event : events) {
      ++now;
      if (event.barrier != nullptr) {
        for (graph::Bits rest = event.barrier->bits; rest != 0; rest &= rest - 1)
          barriers_.at(std::countr_zero(rest)).push_back(now);
        continue;
      }
      for (const graph::BufferAccess& access : event.accesses) compare(access, event.stage, found);
      if (only_first && !found.empty()) return found;
      // Accesses of one command have no order among themselves, so none is compared with another.
      for (const graph::BufferAccess& access : event.accesses)
        accesses_[storage(access)].push_back({now, event.stage, stores(access), adds(access), by_api(access)});
    }
    return found;
  }

  // Which bit of 7.12.2 speaks of this access.
  static graph::Bits bit_of(const graph::BufferAccess& access, bool texture) {
    using graph::Usage;
    if (by_api(access))
      return texture ? graph::bit_texture_update : graph::bit_buffer_update;  // TexSubImage, GetTexImage; BufferSubData, Map
    if (access.usage == Usage::storage) return graph::bit_shader_storage;
    if (access.usage == Usage::image) return graph::bit_shader_image_access;
    if (access.usage == Usage::sampled) return graph::bit_texture_fetch;  // buffer textures too
    if (access.usage == Usage::uniform) return graph::bit_uniform;
    if (access.usage == Usage::vertex) return graph::bit_vertex_attrib_array;
    if (access.usage == Usage::indirect) return graph::bit_command;
    return graph::bit_framebuffer;
  }

 private:
  struct Past {
    int time, stage;
    bool stored, added, by_api;
  };

  static bool by_api(const graph::BufferAccess& access) {
    return access.usage == graph::Usage::host || access.usage == graph::Usage::transfer;
  }
  static bool stores(const graph::BufferAccess& access) {
    return access.access != graph::Access::read && (access.usage == graph::Usage::storage || access.usage == graph::Usage::image);
  }
  static bool adds(const graph::BufferAccess& access) { return stores(access) && access.access == graph::Access::accumulate; }

  [[nodiscard]] std::size_t storage(const graph::BufferAccess& access) const {
    return static_cast<std::size_t>(plan_.buffers[static_cast<std::size_t>(access.buffer)].storage);
  }

  void compare(const graph::BufferAccess& access, int stage, std::vector<Hazard>& found) const {
    const auto buffer = storage(access);
    const graph::Bits bit = bit_of(access, plan_.buffers[static_cast<std::size_t>(access.buffer)].texture);
    const std::vector<int>& named = barriers_.at(std::countr_zero(bit));
    const int last_barrier = named.empty() ? 0 : named.back();
    for (auto past = accesses_[buffer].rbegin(); past != accesses_[buffer].rend(); ++past) {
      if (last_barrier > past->time) return;  // and later than everything before it
      if (past->added && adds(access)) continue;
      const bool overtakes = stores(access) && !past->by_api;
      if (!past->stored && !overtakes) continue;
      const HazardKind kind = !past->stored    ? HazardKind::write_after_read
                              : stores(access) ? HazardKind::write_after_write
                                               : HazardKind::read_after_write;
      found.push_back({kind, access.buffer, past->stage, stage, bit});
      return;
    }
  }

  const graph::Plan& plan_;
  std::vector<std::vector<Past>> accesses_;      // by storage: buffers that share memory are one to the rules
  std::array<std::vector<int>, 11> barriers_{};  // times, by bit
};

}  // namespace firn::test
