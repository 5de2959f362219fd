#pragma once

// All that may happen when a plan runs, as far as short executions show it.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/graph/memory_model.h"

namespace firn::test {

inline void collect_repeats(const std::vector<graph::Op>& ops, std::vector<const graph::Repeat*>& repeats) {
  for (const graph::Op& op : ops)
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) {
      repeats.push_back(repeat);
      collect_repeats(repeat->body, repeats);
    }
}

inline void collect_barriers(std::vector<graph::Op>& ops, std::vector<graph::Barrier*>& barriers) {
  for (graph::Op& op : ops) {
    if (auto* barrier = std::get_if<graph::Barrier>(&op.what)) barriers.push_back(barrier);
    if (auto* repeat = std::get_if<graph::Repeat>(&op.what)) collect_barriers(repeat->body, barriers);
  }
}

inline std::vector<graph::Barrier*> collect_barriers(graph::Plan& plan) {
  std::vector<graph::Barrier*> barriers;
  for (std::vector<graph::Op>* phase : {&plan.setup, &plan.step, &plan.frame}) collect_barriers(*phase, barriers);
  return barriers;
}

// Every order of `length` steps and frames after the setup, with every repeat at one and two turns in all combinations (the first
// six repeats; later ones turn along), all at their maximum, and once with turns and left out stages by chance.
inline std::vector<Trace> executions(const graph::Plan& plan, int length, std::uint64_t seed) {
  std::vector<const graph::Repeat*> repeats;
  for (const std::vector<graph::Op>* phase : {&plan.setup, &plan.step, &plan.frame}) collect_repeats(*phase, repeats);
  const std::size_t combinations = std::size_t{1} << std::min<std::size_t>(repeats.size(), 6);
  const auto all_run = [](int) { return true; };
  std::mt19937_64 random(seed);

  std::vector<Trace> traces;
  for (unsigned order = 0; order < (1u << length); ++order) {
    std::string phases;
    for (int i = 0; i < length; ++i) phases += (order >> i & 1u) == 0 ? 's' : 'f';
    for (std::size_t combination = 0; combination < combinations; ++combination) {
      const auto turns = [&](const graph::Repeat& repeat) {
        const auto index = static_cast<std::size_t>(std::ranges::find(repeats, &repeat) - repeats.begin());
        return std::min<std::int64_t>(repeat.max, 1 + (combination >> (index % 6) & 1u));
      };
      traces.push_back(trace(plan, phases, {turns, all_run}));
    }
    if (!repeats.empty()) traces.push_back(trace(plan, phases, {[](const graph::Repeat& repeat) { return repeat.max; }, all_run}));
    const auto some_turns = [&](const graph::Repeat& repeat) {
      return 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(repeat.max));
    };
    const auto some_run = [&](int stage) {
      const std::int64_t every = plan.stages[static_cast<std::size_t>(stage)].every;
      return every == 1 || random() % static_cast<std::uint64_t>(every) == 0;
    };
    traces.push_back(trace(plan, phases, {some_turns, some_run}));
  }
  return traces;
}

inline std::optional<Hazard> first_hazard(const graph::Plan& plan, const std::vector<Trace>& traces) {
  MemoryModel model(plan);
  for (const Trace& events : traces)
    if (const std::vector<Hazard> found = model.hazards(events, true); !found.empty()) return found.front();
  return std::nullopt;
}

inline std::string describe(const graph::Plan& plan, const Hazard& hazard) {
  const auto label = [&](int stage) {
    return stage < 0 ? std::string("until") : plan.stages[static_cast<std::size_t>(stage)].label;
  };
  constexpr std::array<const char*, 3> kinds{"read after write", "write after read", "write after write"};
  return fmt::format("{} of {}: {}, then {}, without {}", kinds.at(static_cast<std::size_t>(hazard.kind)),
                     plan.buffers[static_cast<std::size_t>(hazard.buffer)].name, label(hazard.earlier), label(hazard.later),
                     graph::bit_names(hazard.bit).front());
}

// What is wrong with a plan's barriers: a hazard that they leave, or a barrier or bit that could be missing as well. Empty:
// nothing.
inline std::string fault_of(graph::Plan& plan, int length, std::uint64_t seed) {
  const std::vector<Trace> traces = executions(plan, length, seed);
  if (const auto hazard = first_hazard(plan, traces)) return describe(plan, *hazard);
  for (graph::Barrier* barrier : collect_barriers(plan)) {
    const graph::Bits bits = barrier->bits;
    if (bits == 0) return "a barrier without bits";
    barrier->bits = 0;
    const bool needed = first_hazard(plan, traces).has_value();
    barrier->bits = bits;
    if (!needed) return fmt::format("a barrier nobody needs: {}", fmt::join(barrier->reasons, "; "));
    if ((bits & (bits - 1)) == 0) continue;
    for (graph::Bits rest = bits; rest != 0; rest &= rest - 1) {
      const graph::Bits bit = rest & ~(rest - 1);
      barrier->bits = bits & ~bit;
      const bool bit_needed = first_hazard(plan, traces).has_value();
      barrier->bits = bits;
      if (!bit_needed)
        return fmt::format("a bit nobody needs: {} of [{}]", graph::bit_names(bit).front(), fmt::join(barrier->reasons, "; "));
    }
  }
  return "";
}

}  // namespace firn::test
