#include "graph/listed_domains.h"

#include <fmt/format.h>

#include <map>
#include <set>

namespace firn::graph {
namespace {

void stages_of(const std::vector<Op>& ops, std::vector<int>& stages) {
  for (const Op& op : ops) {
    if (const auto* repeat = std::get_if<Repeat>(&op.what)) stages_of(repeat->body, stages);
    if (const auto* run = std::get_if<Run>(&op.what); run && (stages.empty() || stages.back() != run->stage))
      stages.push_back(run->stage);
  }
}

class Check {
 public:
  Check(const Plan& plan, config::Diagnostics& diagnostics) : plan_(plan), diagnostics_(diagnostics) {
    for (const auto& [domain, list] : plan.environment.listed_by) lists_[domain] = plan.buffer(list);
  }

  void stage(int index) {
    const PlannedStage& stage = plan_.stages[static_cast<std::size_t>(index)];
    std::set<int> made;  // lists that this stage makes
    for_ports(stage, [&](const Port& port, int buffer, int) {
      if (writes(port.access))
        for (const auto& [domain, list] : lists_)
          if (list == buffer) made.insert(list);
    });
    for_ports(stage, [&](const Port& port, int buffer, int list) {
      if (list < 0 || made.contains(list) || !reads(port.access)) return;
      const auto known = written_for_.find(buffer);
      if (known != written_for_.end() && known->second != version_[list] && told_.insert({index, buffer}).second)
        diagnostics_.error(stage.place,
                           fmt::format("{} reads '{}', which was written for an earlier '{}'; it must be written again first",
                                       stage.label, name(buffer), name(list)));
    });
    for (const int list : made) ++version_[list];
    for_ports(stage, [&](const Port& port, int buffer, int list) {
      if (list >= 0 && writes(port.access)) written_for_[buffer] = version_[list];
    });
  }

 private:
  // All bound ports: port, buffer, the list of its domain (-1: none).
  template <typename Visit>
  void for_ports(const PlannedStage& stage, Visit visit) const {
    for (std::size_t p = 0; p < stage.spec.ports.size(); ++p) {
      if (stage.buffers[p] < 0) continue;
      const auto list = lists_.find(base_domain(stage.spec.ports[p].domain));
      visit(stage.spec.ports[p], stage.buffers[p], list == lists_.end() ? -1 : list->second);
    }
  }
  [[nodiscard]] const std::string& name(int buffer) const { return plan_.buffers[static_cast<std::size_t>(buffer)].name; }

  const Plan& plan_;
  config::Diagnostics& diagnostics_;
  std::map<std::string, int> lists_;          // by domain: the buffer, -1 where the pipeline has none
  std::map<int, int> version_, written_for_;  // of lists; of buffers
  std::set<std::pair<int, int>> told_;
};

}  // namespace

void check_listed_domains(const Plan& plan, config::Diagnostics& diagnostics) {
  if (plan.environment.listed_by.empty()) return;
  Check check(plan, diagnostics);
  std::vector<int> setup, step, frame;
  stages_of(plan.setup, setup);
  stages_of(plan.step, step);
  stages_of(plan.frame, frame);
  // A frame may follow the setup or any step; what crosses the end of a step shows in the second.
  for (const std::vector<int>* phase : {&setup, &frame, &step, &step, &frame})
    for (const int stage : *phase) check.stage(stage);
}

}  // namespace firn::graph
