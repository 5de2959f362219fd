#include "graph/compile.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "config/nearest.h"
#include "graph/barriers.h"
#include "graph/buffer_uses.h"
#include "graph/glsl.h"
#include "graph/lacking.h"
#include "graph/listed_domains.h"
#include "graph/repeats.h"
#include "graph/single_use.h"
#include "graph/stage_file.h"

namespace firn::graph {
namespace {

using config::Diagnostics;

class Compiler {
 public:
  Compiler(const PipelineSpec& pipeline, const Registry& registry, const Environment& environment, Diagnostics& diagnostics,
           const PlanOptions& options)
      : pipeline_(pipeline),
        registry_(registry),
        diagnostics_(diagnostics),
        options_(options),
        traffic_(survey(pipeline, registry, environment)) {
    plan_.pipeline = pipeline.name;
    plan_.file = pipeline.file;
    plan_.environment = environment;
  }

  Plan run() {
    phase(pipeline_.setup, plan_.setup, Phase::setup);
    phase(pipeline_.step, plan_.step, Phase::step);
    phase(pipeline_.frame, plan_.frame, Phase::frame);
    lacking_.tell(diagnostics_);
    check_buffers(plan_, uses_, registry_, diagnostics_);
    check_listed_domains(plan_, diagnostics_);
    if (diagnostics_.has_errors()) return std::move(plan_);
    if (options_.decide_on_device) decide_on_device(plan_);
    lay_out_memory(plan_, uses_, options_.share_memory);
    place_barriers(plan_);
    return std::move(plan_);
  }

 private:
  [[nodiscard]] bool is_wanted(const Port& port, const std::string& buffer) const {
    return (traffic_.written.contains(buffer) && traffic_.read.contains(buffer)) ||
           (writes(port.access) && plan_.environment.provided.contains(buffer));
  }

  void phase(const std::vector<Item>& items, std::vector<Op>& ops, Phase in) {
    for (const Item& item : items) {
      if (const auto* use = std::get_if<StageUse>(&item.what)) stage(*use, ops, in);
      if (const auto* repeat = std::get_if<RepeatUse>(&item.what)) {
        Repeat planned;
        planned.max = repeat->max;
        planned.place = repeat->place;
        phase(repeat->stages, planned.body, in);
        if (planned.body.empty()) continue;
        if (!repeat->until.empty()) until(repeat->until.front(), planned, in);
        ops.emplace_back().what = std::move(planned);
      }
    }
  }

  void until(const Until& until, Repeat& planned, Phase in) {
    const int buffer = plan_.buffer(until.buffer);
    if (buffer < 0) {
      diagnostics_.error(until.place,
                         fmt::format("no buffer '{}' to watch{}", until.buffer, config::suggestion(until.buffer, buffer_names())));
      return;
    }
    const PlannedBuffer& watched = plan_.buffers[static_cast<std::size_t>(buffer)];
    const bool whole = watched.type == ElementType::int1 || watched.type == ElementType::uint1;
    if ((watched.type != ElementType::float1 && !whole) || watched.texture)
      diagnostics_.error(until.place, fmt::format("until needs a buffer of float, int or uint; '{}' is {}{}", until.buffer,
                                                  watched.texture ? "an image of " : "", name(watched.type)));
    if (const double least = watched.type == ElementType::uint1 ? 0.0 : -2147483648.0;
        whole && !(until.below > least && until.below <= 2147483648.0))
      diagnostics_.error(until.place, fmt::format("no {} is below {:g} and another is not; 'below' must lie in what '{}' can hold",
                                                  name(watched.type), until.below, until.buffer));
    uses_[buffer].push_back({until.place, "until", Access::read, Access::read, Usage::transfer, in, false});
    planned.until = PlannedUntil{buffer, until.below, -1};
  }

  [[nodiscard]] std::vector<std::string> buffer_names() const {
    std::vector<std::string> names;
    for (const PlannedBuffer& buffer : plan_.buffers) names.push_back(buffer.name);
    return names;
  }

  void stage(const StageUse& use, std::vector<Op>& ops, Phase in) {
    const StageSpec* spec = spec_of(use, pipeline_, registry_);
    if (is_stage_file(use.stage)) return;  // its head has told what is wrong
    if (pipeline_.stage_files.contains(use.stage) && registry_.find(use.stage) != nullptr)
      diagnostics_.error(use.place, fmt::format("the file of this stage calls it '{}', as one of Firn's own is called", use.stage));
    if (spec == nullptr) {
      diagnostics_.error(use.place,
                         fmt::format("unknown stage '{}'{}", use.stage, config::suggestion(use.stage, registry_.names())));
      return;
    }
    PlannedStage planned;
    planned.label = use.label;
    planned.every = use.every;
    planned.place = use.place;
    planned.spec = *spec;
    planned.parameters = parameter_values(use, *spec, diagnostics_);
    keep_what_holds(planned, plan_.environment);
    for (const std::string& parameter : undecided(planned, *spec))
      diagnostics_.error(use.place, fmt::format("{}: '{}' is {}, but nothing here chooses for it; say what it is to be", use.label,
                                                parameter, automatic));
    const bool bindings_known = check_bindings(use, *spec, planned.spec);
    if (!use.enabled || !bindings_known) return;
    check_constants(use, planned.spec);
    for (const Port& port : planned.spec.ports) planned.buffers.push_back(bind(port, use, planned));
    check_work_domains(use, planned.spec);
    plan_.stages.push_back(planned);
    add_ops(static_cast<int>(plan_.stages.size()) - 1, ops, in);
  }

  bool check_bindings(const StageUse& use, const StageSpec& whole, const StageSpec& active) {
    bool known = true;
    for (const Binding& binding : use.bindings) {
      if (std::ranges::find(active.ports, binding.port, &Port::name) != active.ports.end()) continue;
      known = false;
      std::vector<std::string> names;
      for (const Port& port : active.ports) names.push_back(port.name);
      const bool elsewhere = std::ranges::find(whole.ports, binding.port, &Port::name) != whole.ports.end();
      diagnostics_.error(
          binding.place,
          elsewhere ? fmt::format("{} has port '{}' only with other parameters", use.stage, binding.port)
                    : fmt::format("{} has no port '{}'{}", use.stage, binding.port, config::suggestion(binding.port, names)));
    }
    return known;
  }

  // A domain or constant without a value. What the scene lacks is told at the end, once; a name that the head of a stage's file
  // misspells is told there.
  void unknown(const StageUse& use, const Place& place, const std::string& name, const std::string& text,
               const std::vector<std::string>& known) {
    if (const auto reason = plan_.environment.missing.find(name); reason != plan_.environment.missing.end()) {
      lacking_.note(reason->second, place, use.stage, name, text);
      return;
    }
    std::vector<Place> places{place};
    if (const auto file = pipeline_.stage_files.find(use.stage); file != pipeline_.stage_files.end())
      if (std::vector<Place> in_head = places_in_head(file->second, name); !in_head.empty()) places = std::move(in_head);
    for (const Place& at : places) diagnostics_.error(at, text + config::suggestion(name, known));
  }

  void check_constants(const StageUse& use, const StageSpec& spec) {
    std::vector<std::string> known;
    for (const Constant& constant : plan_.environment.constants) known.push_back(constant.name);
    for (const std::string& constant : spec.constants)
      if (plan_.environment.constant(constant) == nullptr && is_new(use, constant))
        unknown(use, use.place, constant, fmt::format("{} needs '{}', which is not known here", spec.name, constant), known);
  }

  // Once per stage, however many ports have the domain.
  void unknown_domain(const Place& place, const StageUse& use, const std::string& domain) {
    const std::string base = base_domain(domain);
    std::vector<std::string> known;
    for (const auto& [name, size] : plan_.environment.domains) known.push_back(name);
    if (is_new(use, base))
      unknown(use, place, base, fmt::format("{} works on '{}', which is not known here", use.stage, base), known);
  }

  // Uses of a stage's file share one head.
  bool is_new(const StageUse& use, const std::string& name) {
    return unknown_.insert((pipeline_.stage_files.contains(use.stage) ? use.stage : use.label) + " " + name).second;
  }

  void check_work_domains(const StageUse& use, const StageSpec& spec) {
    for (const Work& work : spec.work) {
      std::vector<DomainText> domains;
      if (const auto* dispatch = std::get_if<Dispatch>(&work)) domains = {dispatch->over, dispatch->needs};
      if (const auto* draw = std::get_if<Draw>(&work)) domains = {draw->instances, draw->vertices};
      for (const DomainText& domain : domains)
        if (!domain.empty() && !element_count(domain, plan_.environment)) unknown_domain(use.place, use, domain);
    }
  }

  // The buffer of a port, made where this is the first use of its name. -1: none.
  int bind(const Port& port, const StageUse& use, const PlannedStage& stage) {
    const auto [wanted, told_at] = bound_name(port, use);
    const Place place = told_at.value_or(use.place);
    const auto count = element_count(port.domain, plan_.environment);
    const int existing = plan_.buffer(wanted);
    if (port.optional && !told_at && !is_wanted(port, wanted)) return -1;
    if (!count) {
      unknown_domain(place, use, port.domain);
      return -1;
    }
    constexpr std::uint64_t most = std::uint64_t{1} << 31;
    if (*count > most && existing < 0)
      diagnostics_.error(place, fmt::format("{}: buffer '{}' would have {} elements of '{}', and devices count to 2^31",
                                            stage.spec.name, wanted, *count, port.domain));
    const int index = existing >= 0 ? existing : make_buffer(wanted, port, *count, place);
    if (index < 0) return -1;
    PlannedBuffer& buffer = plan_.buffers[static_cast<std::size_t>(index)];
    if (existing >= 0) match(port, *count, buffer, place, stage);
    const bool texture = is_texel(port.type) || port.usage == Usage::framebuffer || port.usage == Usage::image;
    buffer.texture |= texture;
    if (texture && buffer.width == 0)
      diagnostics_.error(place, fmt::format("{}: port '{}' is an image, but its domain '{}' is not two-dimensional",
                                            stage.spec.name, port.name, port.domain));
    return index;
  }

  int make_buffer(const std::string& name, const Port& port, std::uint64_t count, const Place& place) {
    constexpr std::size_t most_buffers = 2000;
    if (plan_.buffers.size() == most_buffers) {
      if (!too_many_buffers_) diagnostics_.error(place, fmt::format("more than {} buffers in a pipeline", most_buffers));
      too_many_buffers_ = true;
      return -1;
    }
    PlannedBuffer buffer;
    buffer.name = name;
    buffer.type = port.type;
    buffer.domain = port.domain;
    buffer.unit = port.unit;
    buffer.count = count;
    buffer.bytes = count * stride(port.type);
    buffer.place = place;
    if (const auto size = plan_.environment.domains.find(port.domain); size != plan_.environment.domains.end()) {
      buffer.width = size->second.width;
      buffer.height = size->second.height;
    }
    plan_.buffers.push_back(buffer);
    return static_cast<int>(plan_.buffers.size()) - 1;
  }

  void match(const Port& port, std::uint64_t count, const PlannedBuffer& buffer, const Place& place, const PlannedStage& stage) {
    const auto mismatch = [&](std::string_view what, std::string_view theirs, std::string_view ours) {
      diagnostics_.error(place,
                         fmt::format("{}: port '{}' and buffer '{}' differ in {}: the buffer is {} (since {}), the port wants {}",
                                     stage.spec.name, port.name, buffer.name, what, theirs, to_string(buffer.place), ours));
    };
    if (port.type != buffer.type) mismatch("type", name(buffer.type), name(port.type));
    if (port.domain != buffer.domain && (count != buffer.count || base_domain(port.domain) != base_domain(buffer.domain)))
      mismatch("domain", buffer.domain, port.domain);
    if (port.unit != buffer.unit) mismatch("unit", buffer.unit, port.unit);
  }

  void add_ops(int index, std::vector<Op>& ops, Phase in) {
    const PlannedStage& stage = plan_.stages[static_cast<std::size_t>(index)];
    for (int w = 0; w < static_cast<int>(stage.spec.work.size()); ++w) {
      Run run{.stage = index, .work = w, .accesses = {}};
      std::map<int, std::pair<std::string, Access>> touched;
      for (const UsedPort& used : used_ports(stage, stage.spec.work[static_cast<std::size_t>(w)])) {
        const Port& port = stage.spec.ports[static_cast<std::size_t>(used.port)];
        const int buffer = stage.buffers[static_cast<std::size_t>(used.port)];
        if (buffer < 0) continue;
        const auto [other, first] = touched.emplace(buffer, std::pair{port.name, used.access});
        if (!first && (writes(used.access) || writes(other->second.second)))
          diagnostics_.error(
              stage.place,
              fmt::format("{}: ports '{}' and '{}' are both bound to buffer '{}', and one of them writes; bind "
                          "them to two buffers",
                          stage.label, other->second.first, port.name, plan_.buffers[static_cast<std::size_t>(buffer)].name));
        run.accesses.push_back({buffer, used.access, used.usage});
        uses_[buffer].push_back({stage.place, stage.label, used.access, port.access, used.usage, in,
                                 stage.every == 1 && writes_all(stage.spec.work[static_cast<std::size_t>(w)], port, used.access)});
      }
      ops.emplace_back().what = std::move(run);
    }
  }

  const PipelineSpec& pipeline_;
  const Registry& registry_;
  Diagnostics& diagnostics_;
  const PlanOptions options_;
  Plan plan_;
  BufferUses uses_;
  std::set<std::string> unknown_;
  Lacking lacking_;
  bool too_many_buffers_ = false;
  const Traffic traffic_;
};

}  // namespace

int Plan::buffer(const std::string& name) const {
  const auto found = std::ranges::find(buffers, name, &PlannedBuffer::name);
  return found == buffers.end() ? -1 : static_cast<int>(found - buffers.begin());
}

Plan compile(const PipelineSpec& pipeline, const Registry& registry, const Environment& environment, Diagnostics& diagnostics,
             const PlanOptions& options) {
  return Compiler(pipeline, registry, environment, diagnostics, options).run();
}

}  // namespace firn::graph
