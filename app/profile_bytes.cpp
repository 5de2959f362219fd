#include "app/profile_bytes.h"

#include <algorithm>

#include "stages/listed.h"

namespace firn::app {
namespace {

using graph::BufferAccess;
using graph::Plan;
using graph::PlannedBuffer;
using graph::PlannedStage;
using graph::Run;

const graph::Work& work_of(const Plan& plan, int stage, int work) {
  return plan.stages[static_cast<std::size_t>(stage)].spec.work[static_cast<std::size_t>(work)];
}

const graph::Port* port_of(const PlannedStage& stage, int buffer) {
  for (std::size_t p = 0; p < stage.buffers.size(); ++p)
    if (stage.buffers[p] == buffer) return &stage.spec.ports[p];
  return nullptr;
}

double elements(const Plan& plan, const graph::DomainText& domain) {
  return static_cast<double>(graph::element_count(domain, plan.environment).value_or(0));
}

std::string indirect_port(const graph::Work& work) {
  const auto* dispatch = std::get_if<graph::Dispatch>(&work);
  return dispatch == nullptr ? "" : dispatch->indirect;
}

// What its elements are: of places, the domain of their list.
std::string kind(const graph::DomainText& domain) {
  const std::string base = graph::base_domain(domain), list = stages::places(base).list;
  return list.empty() ? base : list;
}
std::string kind_of_elements(const graph::Work& work) {
  const auto* dispatch = std::get_if<graph::Dispatch>(&work);
  if (dispatch == nullptr) return "";
  return kind(dispatch->indirect.empty() ? dispatch->over : stages::groups_of_all(dispatch->indirect));
}

// By kind; whose elements are read in the order of a buffer.
std::string ordered(const Plan& plan, const Run& run) {
  for (const BufferAccess& access : run.accesses)
    if (const PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(access.buffer)];
        stages::is_order(buffer.name) && access.access == graph::Access::read)
      return kind(buffer.domain);
  return "";
}

// The part of a list's domain that is listed for a piece of work, in elements; none: nobody lists them.
std::optional<double> listed(const Plan& plan, const Run& run, const GroupCounts& groups, const std::string& list) {
  const graph::DomainText all = stages::groups_of_all(indirect_port(work_of(plan, run.stage, run.work)));
  if (const std::optional<double> own = groups.of(run); own && graph::base_domain(all) == list)
    return std::min(1.0, *own / elements(plan, all)) * elements(plan, list);
  if (all.empty() && kind_of_elements(work_of(plan, run.stage, run.work)) == list)
    return std::nullopt;  // it goes through all of them
  // What is stored for listed elements only has no others.
  const int stage = plan.environment.listed_by.contains(list) ? -1 : run.stage;
  const std::optional<double> count = groups.by_list(plan, stage, list);
  return count ? std::optional(std::min(*count, elements(plan, list))) : std::nullopt;
}

bool is_cleared(const graph::Work& work, const std::string& port) {
  const auto* draw = std::get_if<graph::Draw>(&work);
  if (draw == nullptr || !draw->clear) return false;
  return draw->depth.empty() ? std::ranges::find(draw->colors, port) != draw->colors.end() : draw->depth == port;
}

}  // namespace

void GroupCounts::add(const Plan& plan, const std::vector<execution::PassGroups>& groups) {
  for (const execution::PassGroups& one : groups) {
    const PlannedStage& stage = plan.stages[static_cast<std::size_t>(one.stage)];
    const std::string port = indirect_port(work_of(plan, one.stage, one.work));
    const auto at = std::ranges::find(stage.spec.ports, port, &graph::Port::name) - stage.spec.ports.begin();
    for (Mean* mean : {&by_work_[{one.stage, one.work}], &by_buffer_[stage.buffers[static_cast<std::size_t>(at)]]}) {
      mean->sum += static_cast<double>(one.groups);
      ++mean->count;
    }
  }
}

std::optional<double> GroupCounts::of(const Run& run) const {
  const auto found = by_work_.find({run.stage, run.work});
  return found == by_work_.end() ? std::nullopt : found->second.value();
}

std::optional<double> GroupCounts::by_list(const Plan& plan, int stage, const std::string& domain) const {
  for (int s = 0; s < static_cast<int>(plan.stages.size()); ++s) {
    if (stage >= 0 && s != stage) continue;
    const PlannedStage& planned = plan.stages[static_cast<std::size_t>(s)];
    for (std::size_t p = 0; p < planned.buffers.size(); ++p)
      if (const auto mean = by_buffer_.find(planned.buffers[p]);
          mean != by_buffer_.end() && stages::groups_of_all(planned.spec.ports[p].name) == domain)
        return mean->second.value();
  }
  return std::nullopt;
}

std::vector<Traffic> traffic_of(const Plan& plan, const Run& run, const GroupCounts& groups) {
  const graph::Work& work = work_of(plan, run.stage, run.work);
  const std::string in_order = ordered(plan, run);
  std::vector<Traffic> traffic;
  for (const BufferAccess& access : run.accesses) {
    const PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(access.buffer)];
    const stages::Places places = stages::places(graph::base_domain(buffer.domain));
    const graph::Port* port = port_of(plan.stages[static_cast<std::size_t>(run.stage)], access.buffer);
    double share = 1;
    bool at_most = false;
    if (!places.list.empty() && !(port != nullptr && is_cleared(work, port->name))) {
      if (const std::optional<double> count = listed(plan, run, groups, places.list))
        share = std::min(1.0, *count / elements(plan, places.whole));
      at_most = kind_of_elements(work) != places.list;
    }
    const std::string own = kind(buffer.domain);
    const bool scattered = !own.empty() && !stages::is_order(buffer.name) && (own != kind_of_elements(work) || own == in_order);
    const double bytes = static_cast<double>(buffer.bytes) * share;
    traffic.push_back({buffer.name, std::string(name(access.access)), std::string(name(access.usage)),
                       graph::reads(access.access) ? bytes : 0, graph::writes(access.access) ? bytes : 0, at_most, scattered});
  }
  return traffic;
}

}  // namespace firn::app
