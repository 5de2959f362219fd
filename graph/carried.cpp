#include "graph/carried.h"

#include <algorithm>
#include <map>
#include <set>

#include "graph/buffer_uses.h"
#include "graph/environment.h"

namespace firn::graph {
namespace {

bool clears(const Work& work, const Port& port) {
  const auto* draw = std::get_if<Draw>(&work);
  return draw != nullptr && draw->clear &&
         (draw->depth == port.name || std::ranges::find(draw->colors, port.name) != draw->colors.end());
}

// Whether nothing of the buffer's former content is left, whenever this piece of work's turn has come.
bool begins_anew(const Plan& plan, const Run& run, const BufferAccess& access) {
  const PlannedStage& stage = plan.stages[static_cast<std::size_t>(run.stage)];
  if (stage.every != 1 || run.groups.buffer >= 0 || access.access != Access::write) return false;
  const Work& work = stage.spec.work[static_cast<std::size_t>(run.work)];
  for (std::size_t p = 0; p < stage.buffers.size(); ++p)
    if (stage.buffers[p] == access.buffer) {
      const Port& port = stage.spec.ports[p];
      if (clears(work, port) || writes_all(work, port, access.access)) return true;
    }
  return false;
}

// Of a phase.
struct FirstUses {
  std::map<int, bool> begun;       // by buffer: whether its first use begins it anew
  std::set<std::string> relisted;  // domains whose list was made anew, so that nobody may read what was stored for the old one
};

void note_lists(const Plan& plan, const Run& run, FirstUses& uses) {
  if (plan.stages[static_cast<std::size_t>(run.stage)].every != 1 || run.groups.buffer >= 0) return;
  for (const auto& [domain, list] : plan.environment.listed_by)
    for (const BufferAccess& access : run.accesses)
      if (access.access == Access::write && access.buffer == plan.buffer(list)) uses.relisted.insert(domain);
}

void collect(const Plan& plan, const std::vector<Op>& ops, FirstUses& uses, bool in_repeat = false) {
  auto& first = uses.begun;
  for (const Op& op : ops) {
    if (const auto* run = std::get_if<Run>(&op.what)) {
      if (!in_repeat) note_lists(plan, *run, uses);
      for (const BufferAccess& access : run->accesses) {
        const std::string domain = base_domain(plan.buffers[static_cast<std::size_t>(access.buffer)].domain);
        const bool for_new_list = uses.relisted.contains(domain) && !reads(access.access);
        first.emplace(access.buffer, for_new_list || begins_anew(plan, *run, access));
      }
    }
    if (const auto* repeat = std::get_if<Repeat>(&op.what)) {
      collect(plan, repeat->body, uses, true);
      if (repeat->until) {
        first.emplace(repeat->until->buffer, false);
        if (repeat->until->progress >= 0) first.emplace(repeat->until->progress, false);
      }
    }
  }
}

}  // namespace

std::vector<int> carried(const Plan& plan) {
  FirstUses in_step, in_frame;
  collect(plan, plan.step, in_step);
  collect(plan, plan.frame, in_frame);
  std::vector<int> buffers;
  for (int b = 0; b < static_cast<int>(plan.buffers.size()); ++b)
    if (std::ranges::any_of(std::vector{&in_step, &in_frame}, [&](const FirstUses* first) {
          const auto found = first->begun.find(b);
          return found != first->begun.end() && !found->second;
        }))
      buffers.push_back(b);
  return buffers;
}

}  // namespace firn::graph
