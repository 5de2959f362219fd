#include <fmt/format.h>

#include "app/explain.h"

namespace firn::app {
namespace {

using nlohmann::json;

const std::string& buffer_name(const graph::Plan& plan, int buffer) { return plan.buffers[static_cast<std::size_t>(buffer)].name; }

json accesses_json(const graph::Plan& plan, const std::vector<graph::BufferAccess>& accesses) {
  json list = json::array();
  for (const graph::BufferAccess& access : accesses)
    list.push_back({{"buffer", buffer_name(plan, access.buffer)},
                    {"access", graph::name(access.access)},
                    {"usage", graph::name(access.usage)}});
  return list;
}

json run_json(const graph::Plan& plan, const graph::Run& run) {
  const graph::PlannedStage& stage = plan.stages[static_cast<std::size_t>(run.stage)];
  const graph::Work& work = stage.spec.work[static_cast<std::size_t>(run.work)];
  const char* op = std::holds_alternative<graph::Dispatch>(work) ? "dispatch"
                   : std::holds_alternative<graph::Draw>(work)   ? "draw"
                                                                 : "host";
  return {{"op", op}, {"stage", stage.label}, {"kernel", work_name(work)}, {"accesses", accesses_json(plan, run.accesses)}};
}

json ops_json(const graph::Plan& plan, const std::vector<graph::Op>& ops);

json repeat_json(const graph::Plan& plan, const graph::Repeat& repeat) {
  json body = ops_json(plan, repeat.body);
  // The host looks for the end after every turn.
  if (repeat.until && repeat.until->progress < 0)
    body.push_back({{"op", "host"},
                    {"stage", "repeat"},
                    {"kernel", "until"},
                    {"accesses", accesses_json(plan, {{repeat.until->buffer, graph::Access::read, graph::Usage::transfer}})}});
  return {{"op", "repeat"}, {"max", repeat.max}, {"body", body}};
}

json ops_json(const graph::Plan& plan, const std::vector<graph::Op>& ops) {
  json list = json::array();
  for (const graph::Op& op : ops) {
    if (const auto* barrier = std::get_if<graph::Barrier>(&op.what))
      list.push_back({{"op", "barrier"}, {"bits", graph::bit_names(barrier->bits)}, {"reasons", barrier->reasons}});
    if (const auto* run = std::get_if<graph::Run>(&op.what)) list.push_back(run_json(plan, *run));
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) list.push_back(repeat_json(plan, *repeat));
  }
  return list;
}

// Accesses that no barrier stands right before, in the order of the runs.
void add_unhindered(const graph::Plan& plan, const std::string& phase, const std::vector<graph::Op>& ops,
                    const graph::RunNotes& notes, std::size_t& at, json& list) {
  const auto add = [&](const std::string& stage, const std::string& kernel, const std::vector<graph::BufferAccess>& accesses) {
    const std::vector<graph::AccessNote>& of_run = notes.at(at++);
    for (std::size_t a = 0; a < accesses.size(); ++a)
      if (of_run[a].order != graph::AccessNote::Order::own_barrier)
        list.push_back({{"phase", phase},
                        {"stage", stage},
                        {"kernel", kernel},
                        {"buffer", buffer_name(plan, accesses[a].buffer)},
                        {"why", of_run[a].why}});
  };
  for (const graph::Op& op : ops) {
    if (const auto* run = std::get_if<graph::Run>(&op.what)) {
      const graph::PlannedStage& stage = plan.stages[static_cast<std::size_t>(run->stage)];
      add(stage.label, work_name(stage.spec.work[static_cast<std::size_t>(run->work)]), run->accesses);
    } else if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) {
      add_unhindered(plan, phase, repeat->body, notes, at, list);
      if (repeat->until && repeat->until->progress < 0)
        add("repeat", "until", {{repeat->until->buffer, graph::Access::read, graph::Usage::transfer}});
    }
  }
}

}  // namespace

nlohmann::json explain_as_json(const graph::Plan& plan) {
  json buffers = json::array(), bindings = json::array(), unhindered = json::array();
  std::uint64_t without_sharing = 0, state = 0, scratch = 0;
  for (const graph::PlannedBuffer& buffer : plan.buffers) {
    const bool is_state = buffer.lifetime == graph::Lifetime::state;
    buffers.push_back({{"name", buffer.name},
                       {"type", graph::name(buffer.type)},
                       {"domain", buffer.domain},
                       {"bytes", buffer.bytes},
                       {"lifetime", is_state ? "state" : "scratch"},
                       {"storage", fmt::format("memory {}", buffer.storage)}});
    without_sharing += buffer.bytes;
    (is_state ? state : scratch) += buffer.bytes;
  }
  for (const graph::PlannedStage& stage : plan.stages)
    for (std::size_t p = 0; p < stage.buffers.size(); ++p)
      if (stage.buffers[p] >= 0)
        bindings.push_back(
            {{"stage", stage.label}, {"port", stage.spec.ports[p].name}, {"buffer", buffer_name(plan, stage.buffers[p])}});
  const graph::PlanNotes notes = graph::explain_accesses(plan);
  json phases = json::object();
  for (const auto& [name, ops, of_phase] :
       {std::tuple{"setup", &plan.setup, &notes.setup}, {"step", &plan.step, &notes.step}, {"frame", &plan.frame, &notes.frame}}) {
    phases[name] = ops_json(plan, *ops);
    std::size_t at = 0;
    add_unhindered(plan, name, *ops, *of_phase, at, unhindered);
  }
  return {{"pipeline", plan.pipeline},
          {"phases", phases},
          {"buffers", buffers},
          {"memory", {{"bytes", plan.bytes}, {"without_sharing", without_sharing}, {"state", state}, {"scratch", scratch}}},
          {"bindings", bindings},
          {"unhindered", unhindered}};
}

}  // namespace firn::app
