#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "app/explain.h"

namespace firn::app {
namespace {

constexpr double mebi = 1 << 20;

class Writer {
 public:
  explicit Writer(const graph::Plan& plan) : plan_(plan), notes_(graph::explain_accesses(plan)) {}

  std::string write(const std::string& doc) {
    text_ = fmt::format("{}{}\n", plan_.pipeline, doc.empty() ? "" : ": " + doc);
    phase("setup, once", plan_.setup, notes_.setup);
    phase("step, as every one after the first", plan_.step, notes_.step);
    phase("frame, for every picture", plan_.frame, notes_.frame);
    buffers();
    memory();
    return text_;
  }

 private:
  void phase(const char* title, const std::vector<graph::Op>& ops, const graph::RunNotes& notes) {
    if (ops.empty()) return;
    text_ += fmt::format("\n{}\n", title);
    std::size_t at = 0;
    this->ops(ops, notes, at, "  ");
  }

  void ops(const std::vector<graph::Op>& ops, const graph::RunNotes& notes, std::size_t& at, const std::string& indent) {
    for (const graph::Op& op : ops) {
      if (const auto* barrier = std::get_if<graph::Barrier>(&op.what)) {
        text_ += fmt::format("{}--- barrier: {}\n", indent, fmt::join(graph::bit_names(barrier->bits), ", "));
        for (const std::string& reason : barrier->reasons) text_ += fmt::format("{}    because of {}\n", indent, reason);
      } else if (const auto* run = std::get_if<graph::Run>(&op.what)) {
        this->run(*run, notes.at(at++), indent);
      } else if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) {
        this->repeat(*repeat, notes, at, indent);
      }
    }
  }

  void repeat(const graph::Repeat& repeat, const graph::RunNotes& notes, std::size_t& at, const std::string& indent) {
    std::string until;
    if (repeat.until)
      until = fmt::format(" at most, until {} is below {:g}; {} finds that out", name(repeat.until->buffer), repeat.until->below,
                          repeat.until->progress < 0 ? "the host" : "the device");
    text_ += fmt::format("{}repeat {} times{}\n", indent, repeat.max, until);
    ops(repeat.body, notes, at, indent + "  ");
    if (repeat.until && repeat.until->progress < 0)
      access({repeat.until->buffer, graph::Access::read, graph::Usage::transfer}, "", notes.at(at++).front(), indent + "  ");
  }

  void run(const graph::Run& run, const std::vector<graph::AccessNote>& notes, const std::string& indent) {
    const graph::PlannedStage& stage = plan_.stages[static_cast<std::size_t>(run.stage)];
    const graph::Work& work = stage.spec.work[static_cast<std::size_t>(run.work)];
    std::string what = work_name(work);
    if (const auto* dispatch = std::get_if<graph::Dispatch>(&work))
      what +=
          dispatch->over.empty() ? fmt::format(", groups from {}", dispatch->indirect) : fmt::format(" over {}", dispatch->over);
    else if (std::holds_alternative<graph::Draw>(work))
      what = "draws " + what;
    text_ += fmt::format("{}{}  {}{}\n", indent, stage.label, what,
                         stage.every == 1 ? "" : fmt::format(", every {}th time", stage.every));
    for (std::size_t a = 0; a < run.accesses.size(); ++a)
      access(run.accesses[a], port_of(stage, run.accesses[a].buffer), notes[a], indent);
  }

  void access(const graph::BufferAccess& access, const std::string& port, const graph::AccessNote& note,
              const std::string& indent) {
    using Order = graph::AccessNote::Order;
    const std::string& buffer = name(access.buffer);
    const std::string order = note.order == Order::own_barrier ? "waits: " + note.why
                              : note.order == Order::missing   ? "NOT IN ORDER: " + note.why
                                                               : "no barrier: " + note.why;
    text_ += fmt::format("{}    {:<10} {:<26} {:<11} {}\n", indent, graph::name(access.access),
                         port.empty() || port == buffer ? buffer : fmt::format("{} (port {})", buffer, port),
                         graph::name(access.usage), order);
  }

  [[nodiscard]] static std::string port_of(const graph::PlannedStage& stage, int buffer) {
    const auto found = std::ranges::find(stage.buffers, buffer);
    return found == stage.buffers.end() ? "" : stage.spec.ports[static_cast<std::size_t>(found - stage.buffers.begin())].name;
  }

  [[nodiscard]] const std::string& name(int buffer) const { return plan_.buffers[static_cast<std::size_t>(buffer)].name; }

  void buffers() {
    std::map<int, std::vector<std::string>> residents;
    for (const graph::PlannedBuffer& buffer : plan_.buffers) residents[buffer.storage].push_back(buffer.name);
    text_ += fmt::format("\n{:<26} {:<6} {:<14} {:>10} {:>10}  {:<8} {}\n", "buffer", "type", "domain", "elements", "MiB",
                         "lifetime", "memory");
    for (const graph::PlannedBuffer& buffer : plan_.buffers) {
      std::vector<std::string> others = residents.at(buffer.storage);
      std::erase(others, buffer.name);
      text_ += fmt::format("{:<26} {:<6} {:<14} {:>10} {:>10.3f}  {:<8} {}{}\n", buffer.name, graph::name(buffer.type),
                           buffer.domain, buffer.count, static_cast<double>(buffer.bytes) / mebi,
                           buffer.lifetime == graph::Lifetime::state ? "state" : "scratch", buffer.storage,
                           others.empty() ? "" : fmt::format(", shared with {}", fmt::join(others, ", ")));
    }
  }

  void memory() {
    std::uint64_t separate = 0;
    for (const graph::PlannedBuffer& buffer : plan_.buffers) separate += buffer.bytes;
    text_ += fmt::format("\nmemory: {:.3f} MiB on the device in {} buffers", static_cast<double>(plan_.bytes) / mebi,
                         plan_.buffers.size());
    if (separate > plan_.bytes)
      text_ += fmt::format("; without sharing it would be {:.3f} MiB", static_cast<double>(separate) / mebi);
    text_ += "\n";
  }

  const graph::Plan& plan_;
  const graph::PlanNotes notes_;
  std::string text_;
};

}  // namespace

std::string explain_as_text(const graph::Plan& plan, const std::string& doc) { return Writer(plan).write(doc); }

}  // namespace firn::app
