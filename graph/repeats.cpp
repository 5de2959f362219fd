#include "graph/repeats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace firn::graph {
namespace {

constexpr int most_own_counts = 4;  // as many optional ports as shaders/repeat/until.comp has

void each_run(std::vector<Op>& ops, const std::function<void(Run&)>& visit) {
  for (Op& op : ops) {
    if (auto* run = std::get_if<Run>(&op.what)) visit(*run);
    if (auto* repeat = std::get_if<Repeat>(&op.what)) each_run(repeat->body, visit);
  }
}

bool holds_until(const std::vector<Op>& ops) {
  return std::ranges::any_of(ops, [](const Op& op) {
    const auto* repeat = std::get_if<Repeat>(&op.what);
    return repeat != nullptr && (repeat->until || holds_until(repeat->body));
  });
}

StageSpec deciding_stage(const PlannedBuffer& watched, int slots, std::size_t own_counts) {
  StageSpec spec;
  spec.name = "repeat.until";
  spec.doc = "Ends a repeat: sets the groups of its dispatches to zero once all that it watches is below the limit";
  spec.ports = {
      {.name = "watched", .type = watched.type, .domain = watched.domain, .unit = watched.unit, .doc = "what is compared"},
      {.name = "progress",
       .type = ElementType::uint1,
       .domain = std::to_string(progress_size),
       .access = Access::read_write,
       .unit = "1",
       .doc = "this turn, whether the end is reached, turns in all, rounds in all"},
      {.name = "groups",
       .type = ElementType::uint1,
       .domain = std::to_string(6 * slots),
       .access = Access::read_write,
       .unit = "1",
       .doc = "group counts of the dispatches, then what they are until the end is reached"}};
  for (int i = 0; i < most_own_counts; ++i)
    spec.ports.push_back({.name = fmt::format("own_groups_{}", i),
                          .type = ElementType::uint1,
                          .domain = "3",
                          .access = Access::write,
                          .unit = "1",
                          .doc = "group counts that a stage of the repeat makes itself",
                          .optional = true});
  spec.parameters = {
      {.name = "elements", .kind = ParameterKind::integer, .initial = std::int64_t{1}, .doc = "elements that are compared"},
      {.name = "below", .initial = 0.0, .doc = "limit for floats"},
      {.name = "largest",
       .kind = ParameterKind::integer,
       .initial = std::int64_t{0},
       .doc = "largest whole number below the limit"},
      {.name = "max_turns", .kind = ParameterKind::integer, .initial = std::int64_t{1}, .doc = "turns after which it ends anyway"},
      {.name = "slots", .kind = ParameterKind::integer, .initial = std::int64_t{slots}, .doc = "dispatches"},
      {.name = "watched_type",
       .kind = ParameterKind::choice,
       .initial = std::string("float"),
       .choices = {"float", "int", "uint"},
       .doc = "what is compared"}};
  Dispatch dispatch{
      .kernel = "repeat/until.comp", .over = watched.count == 1 ? "1" : "256", .group = watched.count == 1 ? 16 : 256};
  if (own_counts < most_own_counts) {
    for (std::size_t p = 0; p < 3 + own_counts; ++p) dispatch.uses.push_back({spec.ports[p].name, spec.ports[p].access});
  }
  spec.work = {dispatch};
  return spec;
}

class Decision {
 public:
  Decision(Plan& plan, Repeat& repeat) : plan_(plan), repeat_(repeat) {}

  [[nodiscard]] bool possible() {
    if (!repeat_.until || repeat_.max == 1 || holds_until(repeat_.body)) return false;
    bool only_dispatches = true;
    each_run(repeat_.body, [&](Run& run) {
      const auto* dispatch = std::get_if<Dispatch>(&work_of(run));
      only_dispatches &= dispatch != nullptr;
      if (dispatch != nullptr && !dispatch->indirect.empty())
        for (const BufferAccess& access : run.accesses)
          if (access.usage == Usage::indirect) own_counts_.insert(access.buffer);
    });
    return only_dispatches && own_counts_.size() <= most_own_counts &&
           std::ranges::all_of(own_counts_, [&](int buffer) { return made_by_every_turn(buffer) && !used_elsewhere(buffer); });
  }

  void make() {
    std::vector<std::uint32_t> counts;
    int slots = 0;
    each_run(repeat_.body, [&](Run& run) {
      const auto& dispatch = std::get<Dispatch>(work_of(run));
      if (!dispatch.indirect.empty()) return;
      for (const std::uint32_t count : group_counts(element_count(dispatch.over, plan_.environment).value_or(0), dispatch.group))
        counts.push_back(count);
      run.groups = GroupCounts{static_cast<int>(plan_.buffers.size()), slots++};
    });
    const int groups = add_buffer("groups", 6 * static_cast<std::uint64_t>(slots));
    const std::vector<std::uint32_t> full = counts;
    counts.insert(counts.end(), full.begin(), full.end());
    plan_.buffers.back().initial = counts;
    each_run(repeat_.body, [&](Run& run) {
      if (run.groups.buffer >= 0) run.accesses.push_back({groups, Access::read, Usage::indirect});
    });
    repeat_.until->progress = add_buffer("progress", progress_size);
    add_stage(groups, slots);
  }

 private:
  [[nodiscard]] const Work& work_of(const Run& run) const {
    return plan_.stages[static_cast<std::size_t>(run.stage)].spec.work[static_cast<std::size_t>(run.work)];
  }

  // Whether the body itself, in every turn, writes the buffer before anything else looks at it.
  [[nodiscard]] bool made_by_every_turn(int buffer) const {
    for (const Op& op : repeat_.body) {
      if (const auto* run = std::get_if<Run>(&op.what)) {
        for (const BufferAccess& access : run->accesses)
          if (access.buffer == buffer)
            return access.access == Access::write && plan_.stages[static_cast<std::size_t>(run->stage)].every == 1;
      } else {
        return false;
      }
    }
    return false;
  }

  [[nodiscard]] bool used_elsewhere(int buffer) {
    int inside = 0, everywhere = 0;
    const auto count = [&](int& uses) {
      return
          [&uses, buffer](Run& run) { uses += static_cast<int>(std::ranges::count(run.accesses, buffer, &BufferAccess::buffer)); };
    };
    each_run(repeat_.body, count(inside));
    for (std::vector<Op>* phase : {&plan_.setup, &plan_.step, &plan_.frame}) each_run(*phase, count(everywhere));
    const std::string& name = plan_.buffers[static_cast<std::size_t>(buffer)].name;
    return inside != everywhere || plan_.environment.provided.contains(name) || repeat_.until->buffer == buffer;
  }

  int add_buffer(const std::string& what, std::uint64_t count) {
    const int number = 1 + static_cast<int>(std::ranges::count(plan_.stages, "repeat.until",
                                                               [](const PlannedStage& stage) { return stage.spec.name; }));
    PlannedBuffer buffer;
    buffer.name = fmt::format("repeat#{} {}", number, what);
    buffer.type = ElementType::uint1;
    buffer.domain = std::to_string(count);
    buffer.unit = "1";
    buffer.count = count;
    buffer.bytes = count * stride(buffer.type);
    buffer.storage = static_cast<int>(plan_.buffers.size());
    buffer.place = repeat_.place;
    plan_.buffers.push_back(buffer);
    return static_cast<int>(plan_.buffers.size()) - 1;
  }

  void add_stage(int groups, int slots) {
    const PlannedUntil& until = *repeat_.until;
    const PlannedBuffer& watched = plan_.buffers[static_cast<std::size_t>(until.buffer)];
    PlannedStage stage;
    stage.spec = deciding_stage(watched, slots, own_counts_.size());
    stage.label = fmt::format("until {}", watched.name);
    const auto taken = [&](const std::string& label) {
      return std::ranges::find(plan_.stages, label, &PlannedStage::label) != plan_.stages.end();
    };
    for (int n = 2; taken(stage.label); ++n) stage.label = fmt::format("until {}#{}", watched.name, n);
    stage.place = repeat_.place;
    for (const ParameterSpec& parameter : stage.spec.parameters) stage.parameters[parameter.name] = parameter.initial;
    stage.parameters["elements"] = static_cast<std::int64_t>(watched.count);
    stage.parameters["below"] = until.below;
    stage.parameters["largest"] = largest_below(until.below);
    stage.parameters["max_turns"] = repeat_.max;
    stage.parameters["watched_type"] = std::string(name(watched.type));
    stage.buffers = {until.buffer, until.progress, groups};
    stage.buffers.insert(stage.buffers.end(), own_counts_.begin(), own_counts_.end());
    stage.buffers.resize(stage.spec.ports.size(), -1);
    Run run{.stage = static_cast<int>(plan_.stages.size()), .work = 0, .accesses = {}};
    for (std::size_t p = 0; p < stage.buffers.size(); ++p)
      if (stage.buffers[p] >= 0) run.accesses.push_back({stage.buffers[p], stage.spec.ports[p].access, Usage::storage});
    plan_.stages.push_back(std::move(stage));
    repeat_.body.emplace_back().what = std::move(run);
  }

  Plan& plan_;
  Repeat& repeat_;
  std::set<int> own_counts_;
};

void decide(Plan& plan, std::vector<Op>& ops) {
  for (Op& op : ops)
    if (auto* repeat = std::get_if<Repeat>(&op.what)) {
      if (Decision decision(plan, *repeat); decision.possible())
        decision.make();
      else
        decide(plan, repeat->body);
    }
}

}  // namespace

std::array<std::uint32_t, 3> group_counts(std::uint64_t elements, int group) {
  constexpr std::uint64_t row = 32768;
  const std::uint64_t per_group = static_cast<std::uint64_t>(group);
  const std::uint64_t groups = (elements + per_group - 1) / per_group;
  if (groups <= row) return {static_cast<std::uint32_t>(groups), 1, 1};
  return {static_cast<std::uint32_t>(row), static_cast<std::uint32_t>((groups + row - 1) / row), 1};
}

std::int64_t largest_below(double limit) {
  constexpr double bound = 2147483647.0;
  return static_cast<std::int64_t>(std::clamp(std::ceil(limit) - 1, -bound, bound));
}

void decide_on_device(Plan& plan) {
  for (std::vector<Op>* phase : {&plan.setup, &plan.step, &plan.frame}) decide(plan, *phase);
}

}  // namespace firn::graph
