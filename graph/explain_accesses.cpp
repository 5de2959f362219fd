#include "graph/explain_accesses.h"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "graph/barriers.h"

namespace firn::graph {
namespace {

struct Passed {
  int number = 0;      // of the barrier, counted along the replay
  std::string before;  // what comes after it
};

// An earlier access that later ones may have to wait for, and the barriers since.
struct Earlier {
  std::string who, verb;
  int buffer = -1;
  std::map<Bits, Passed> barriers;  // by bit: the first one
};

struct StorageState {
  // Accumulations are kept apart: among themselves they need no order (barriers.h).
  std::optional<Earlier> written, added;         // by shaders: later accesses must see it
  std::optional<Earlier> touched, touched_adds;  // by anything on the device: later shader writes must come after it
  std::string api_writer;                        // the last of those that OpenGL orders itself
};

const char* verb(Access access) {
  return access == Access::read ? "read" : access == Access::accumulate ? "accumulated" : "written";
}

class Replay {
 public:
  explicit Replay(const Plan& plan) : plan_(plan), states_(plan.buffers.size()) {}

  RunNotes phase(const std::vector<Op>& ops, const std::string& end) {
    RunNotes notes;
    run(ops, end, &notes);
    return notes;
  }

 private:
  void run(const std::vector<Op>& ops, const std::string& end, RunNotes* notes) {
    own_barrier_ = 0;
    for (std::size_t i = 0; i < ops.size(); ++i) {
      if (const auto* barrier = std::get_if<Barrier>(&ops[i].what)) {
        pass(barrier->bits, i + 1 < ops.size() ? first_of(ops[i + 1]) : end);
      } else if (const auto* work = std::get_if<Run>(&ops[i].what)) {
        accesses(work->accesses, name_of(*work), notes);
        own_barrier_ = 0;
      } else if (const auto* repeat = std::get_if<Repeat>(&ops[i].what)) {
        if (repeat->max > 1) turn(*repeat, nullptr);
        turn(*repeat, notes);
        own_barrier_ = 0;
      }
    }
  }

  void turn(const Repeat& repeat, RunNotes* notes) {
    run(repeat.body, "the end of the turn", notes);
    if (repeat.until && repeat.until->progress < 0)
      accesses({{repeat.until->buffer, Access::read, Usage::transfer}}, "the end of the turn", notes);
  }

  [[nodiscard]] std::string first_of(const Op& op) const {
    if (const auto* work = std::get_if<Run>(&op.what)) return name_of(*work);
    if (const auto* repeat = std::get_if<Repeat>(&op.what); repeat != nullptr && !repeat->body.empty())
      return first_of(repeat->body.front());
    return "the next work";
  }

  // The stage, and where it has several pieces of work, which one.
  [[nodiscard]] std::string name_of(const Run& run) const {
    const PlannedStage& stage = plan_.stages[static_cast<std::size_t>(run.stage)];
    if (stage.spec.work.size() < 2) return stage.label;
    const Work& work = stage.spec.work[static_cast<std::size_t>(run.work)];
    if (const auto* dispatch = std::get_if<Dispatch>(&work))
      return fmt::format("{} ({})", stage.label, dispatch->kernel.substr(dispatch->kernel.rfind('/') + 1));
    if (const auto* draw = std::get_if<Draw>(&work)) return fmt::format("{} ({})", stage.label, draw->name);
    return stage.label + " (host)";
  }

  void pass(Bits bits, const std::string& before) {
    own_barrier_ = ++barriers_;
    for (StorageState& state : states_)
      for (std::optional<Earlier>* earlier : {&state.written, &state.added, &state.touched, &state.touched_adds})
        if (earlier->has_value())
          for (Bits bit = 1; bit <= bits; bit <<= 1)
            if ((bits & bit) != 0) (*earlier)->barriers.emplace(bit, Passed{barriers_, before});
  }

  void accesses(const std::vector<BufferAccess>& list, const std::string& who, RunNotes* notes) {
    std::vector<AccessNote> of_run;
    for (const BufferAccess& access : list) of_run.push_back(note(access));
    for (const BufferAccess& access : list) apply(access, who);
    if (notes != nullptr) notes->push_back(std::move(of_run));
  }

  [[nodiscard]] const PlannedBuffer& buffer_of(const BufferAccess& access) const {
    return plan_.buffers[static_cast<std::size_t>(access.buffer)];
  }
  [[nodiscard]] std::size_t storage_of(const BufferAccess& access) const {
    return static_cast<std::size_t>(buffer_of(access).storage);
  }

  [[nodiscard]] AccessNote note(const BufferAccess& access) const {
    const StorageState& state = states_[storage_of(access)];
    const bool accumulates = access.access == Access::accumulate, changes = is_shader_write(access);
    std::vector<const Earlier*> before;
    const auto add = [&](const std::optional<Earlier>& earlier, bool counts) {
      if (earlier && counts) before.push_back(&*earlier);
    };
    add(state.written, true);
    add(state.added, !accumulates);
    add(state.touched, changes);
    add(state.touched_adds, changes && !accumulates);
    const Bits bit = consumer_bit(access.usage, buffer_of(access).texture);
    const Earlier* last = nullptr;
    for (const Earlier* earlier : before) {
      const auto passed = earlier->barriers.find(bit);
      if (passed == earlier->barriers.end()) return {AccessNote::Order::missing, told(*earlier, access)};
      if (last == nullptr || passed->second.number > last->barriers.at(bit).number) last = earlier;
    }
    if (last != nullptr) {
      const Passed& passed = last->barriers.at(bit);
      if (passed.number == own_barrier_) return {AccessNote::Order::own_barrier, told(*last, access)};
      return {AccessNote::Order::earlier_barrier, fmt::format("{}, waited for before {}", told(*last, access), passed.before)};
    }
    return {AccessNote::Order::none_needed, why_none(access, state)};
  }

  // Of another buffer in the same memory its name is told: whoever used that one knows nothing of this one.
  [[nodiscard]] std::string told(const Earlier& earlier, const BufferAccess& access) const {
    if (earlier.buffer == access.buffer) return fmt::format("{} by {}", earlier.verb, earlier.who);
    return fmt::format("its memory held {}, {} by {}", plan_.buffers[static_cast<std::size_t>(earlier.buffer)].name, earlier.verb,
                       earlier.who);
  }

  [[nodiscard]] static std::string why_none(const BufferAccess& access, const StorageState& state) {
    if (access.access == Access::accumulate && state.added)
      return fmt::format("{} added to it as well: sums may come in any order", state.added->who);
    if (!state.api_writer.empty() && reads(access.access))
      return fmt::format("written by {}, which OpenGL orders by itself", state.api_writer);
    if (is_shader_write(access) || !state.touched) return "nothing on the device has touched it before";
    return "no shader has written to it";
  }

  void apply(const BufferAccess& access, const std::string& who) {
    StorageState& state = states_[storage_of(access)];
    const bool accumulates = access.access == Access::accumulate;
    const Earlier now{who, verb(access.access), access.buffer, {}};
    if (is_shader_write(access)) (accumulates ? state.added : state.written) = now;
    if (writes(access.access)) state.api_writer = is_shader_write(access) ? "" : who;
    if (access.usage == Usage::host || access.usage == Usage::transfer) return;
    (accumulates ? state.touched_adds : state.touched) = now;
  }

  const Plan& plan_;
  std::vector<StorageState> states_;
  int barriers_ = 0;
  int own_barrier_ = 0;  // the one right before the work that comes next; 0: none
};

}  // namespace

PlanNotes explain_accesses(const Plan& plan) {
  PlanNotes notes;
  Replay replay(plan);
  notes.setup = replay.phase(plan.setup, "the end of the setup");
  replay.phase(plan.step, "the end of the step");
  notes.step = replay.phase(plan.step, "the end of the step");
  notes.frame = replay.phase(plan.frame, "the end of the frame");
  return notes;
}

}  // namespace firn::graph
