#include "graph/barriers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <utility>

#include "graph/barrier_state.h"

namespace firn::graph {
namespace {

constexpr std::array<std::pair<Bit, const char*>, bit_count> bit_table{{
    {bit_vertex_attrib_array, "vertex_attrib_array"},
    {bit_element_array, "element_array"},
    {bit_uniform, "uniform"},
    {bit_texture_fetch, "texture_fetch"},
    {bit_shader_image_access, "shader_image_access"},
    {bit_command, "command"},
    {bit_pixel_buffer, "pixel_buffer"},
    {bit_texture_update, "texture_update"},
    {bit_buffer_update, "buffer_update"},
    {bit_framebuffer, "framebuffer"},
    {bit_shader_storage, "shader_storage"},
}};
constexpr Bits every_bit = (1u << bit_count) - 1;
constexpr Bits write_bits = bit_shader_storage | bit_shader_image_access;  // the bits that later shader writes wait at

// Replaying ops distributes over joins of states: what is open at the end is what the ops leave open themselves, and what was open
// before and not closed by their barriers. So pairs of phases are enough to look at; longer ways leave no more open than these.
class Placement {
  using State = MemoryState;

 public:
  explicit Placement(Plan& plan) : plan_(plan) {}

  void run() {
    State state = clean();
    plan_.setup = emit(plan_.setup, state);

    const std::vector<Op> step = std::move(plan_.step);
    state = clean();
    plan_.step = steady([&](State& s) { return emit(step, s); }, state);

    // In a run a frame comes after steps, which come after the last frame.
    const std::vector<Op> frame = std::move(plan_.frame);
    plan_.frame = steady(
        [&](State& s) {
          s = after(plan_.step, std::move(s));
          return emit(frame, s);
        },
        state);

    // The first step and frame, a frame drawn again, a step after a frame.
    for (std::vector<Op>* phase : {&plan_.setup, &plan_.frame})
      for (const std::vector<Op>* next : {&plan_.step, &plan_.frame}) close(*phase, missing(*next, after(*phase, clean())).bits);

    // Barriers that came later can make earlier ones superfluous, round a loop or where a phase was closed. Steps come first: they
    // run most.
    for (std::vector<Op>* phase : {&plan_.step, &plan_.frame, &plan_.setup}) drop_needless_bits(*phase);
    for (std::vector<Op>* phase : {&plan_.step, &plan_.frame, &plan_.setup}) give_reasons(*phase);
  }

 private:
  using Body = std::function<std::vector<Op>(State&)>;

  [[nodiscard]] State clean() const { return State(plan_.buffers.size()); }

  [[nodiscard]] Bits access_bit(const BufferAccess& access) const {
    return consumer_bit(access.usage, plan_.buffers[static_cast<std::size_t>(access.buffer)].texture);
  }

  [[nodiscard]] std::size_t storage(const BufferAccess& access) const {
    return static_cast<std::size_t>(plan_.buffers[static_cast<std::size_t>(access.buffer)].storage);
  }
  [[nodiscard]] const std::string& name(int buffer) const { return plan_.buffers[static_cast<std::size_t>(buffer)].name; }

  [[nodiscard]] const std::string& label(int stage) const { return plan_.stages[static_cast<std::size_t>(stage)].label; }

  static const char* verb(Access access) {
    return access == Access::read ? "read" : access == Access::accumulate ? "accumulated" : "written";
  }

  // Adds the bits that one access waits for, and why.
  void need(const BufferAccess& access, const std::string& who, const State& state, Barrier& barrier) const {
    const StorageState buffer = state.at(storage(access));
    const bool accumulates = access.access == Access::accumulate;
    const Bits bit = access_bit(access);
    const Bits stale = buffer.stale | (accumulates ? 0 : buffer.stale_accumulated);
    const Bits unordered = buffer.unordered | (accumulates ? 0 : buffer.unordered_accumulated);
    const bool sees_old = (stale & bit) != 0;
    const bool overtakes = is_shader_write(access) && (unordered & bit) != 0;
    if (!sees_old && !overtakes) return;
    const StorageState::Last& earlier = sees_old ? buffer.written : buffer.accessed;
    const std::string shared =
        earlier.buffer == access.buffer ? "" : fmt::format(", in memory that was {}'s", name(earlier.buffer));
    const std::string reason = fmt::format("{}{}: {} by {}, {} by {}", name(access.buffer), shared, verb(earlier.access),
                                           label(earlier.stage), verb(access.access), who);
    barrier.bits |= bit;
    if (std::ranges::find(barrier.reasons, reason) == barrier.reasons.end()) barrier.reasons.push_back(reason);
  }

  void apply(const BufferAccess& access, int stage, State& state) const {
    StorageState& buffer = state.change(storage(access));
    const bool accumulates = access.access == Access::accumulate;
    if (is_shader_write(access)) {
      (accumulates ? buffer.stale_accumulated : buffer.stale) = every_bit;
      buffer.written = {stage, access.access, access.buffer};
    }
    // The API's own accesses are done, or ordered by OpenGL, when the next command starts.
    if (access.usage == Usage::host || access.usage == Usage::transfer) return;
    (accumulates ? buffer.unordered_accumulated : buffer.unordered) |= write_bits;
    buffer.accessed = {stage, access.access, access.buffer};
  }

  void need_until(const Repeat& repeat, const State& state, Barrier& barrier) const {
    if (repeat.until && repeat.until->progress < 0)
      need({repeat.until->buffer, Access::read, Usage::transfer}, "the end of the repeat", state, barrier);
  }

  static void place(Bits bits, State& state, std::vector<Op>& ops) {
    if (bits == 0) return;
    state.barrier(bits);
    ops.emplace_back().what = Barrier{bits, {}};
  }

  // `ops`, which hold no barriers, with those that they need when they start in `state`; leaves the state at their end.
  std::vector<Op> emit(const std::vector<Op>& ops, State& state) {
    std::vector<Op> placed;
    for (const Op& op : ops) {
      if (const auto* run = std::get_if<Run>(&op.what)) {
        Barrier barrier;
        for (const BufferAccess& access : run->accesses) need(access, label(run->stage), state, barrier);
        place(barrier.bits, state, placed);
        for (const BufferAccess& access : run->accesses) apply(access, run->stage, state);
        placed.push_back(op);
      } else if (const auto* repeat = std::get_if<Repeat>(&op.what)) {
        emit_repeat(*repeat, state, placed);
      }
    }
    return placed;
  }

  void emit_repeat(const Repeat& repeat, State& state, std::vector<Op>& placed) {
    Repeat planned = repeat;
    State own = clean();
    planned.body = steady(
        [&](State& s) {
          std::vector<Op> ops = emit(repeat.body, s);
          Barrier barrier;
          need_until(repeat, s, barrier);
          place(barrier.bits, s, ops);
          return ops;
        },
        own);
    // What only the first turn needs stands before the loop.
    const Op op{planned};
    place(missing({op}, state).bits, state, placed);
    placed.push_back(op);
    state = after({op}, std::move(state));
  }

  // A body with the barriers it needs when it follows itself: it starts from all that may be open, until nothing is added.
  // `state`: where the search starts; afterwards: at the body's end.
  static std::vector<Op> steady(const Body& body, State& state) {
    for (State start = state;;) {
      state = start;
      std::vector<Op> ops = body(state);
      if (!start.join(state)) return ops;
    }
  }

  // Runs planned ops; collects in `open` what their own barriers leave open. Ends early once barriers have closed all of `left`.
  void replay(std::span<const Op> ops, State& state, Barrier& open, Bits left = ~Bits{0}) const {
    for (const Op& op : ops) {
      if (const auto* barrier = std::get_if<Barrier>(&op.what)) {
        state.barrier(barrier->bits);
        left &= ~barrier->bits;
        if (left == 0) return;
      } else if (const auto* run = std::get_if<Run>(&op.what)) {
        for (const BufferAccess& access : run->accesses) need(access, label(run->stage), state, open);
        for (const BufferAccess& access : run->accesses) apply(access, run->stage, state);
      } else if (const auto* repeat = std::get_if<Repeat>(&op.what)) {
        // One turn may be all there is; the second stands for all later ones.
        replay(repeat->body, state, open);
        need_until(*repeat, state, open);
        if (repeat->max == 1) continue;
        const State once = state;
        replay(repeat->body, state, open);
        need_until(*repeat, state, open);
        state.join(once);
      }
    }
  }

  [[nodiscard]] Barrier missing(const std::vector<Op>& ops, State state) const {
    Barrier open;
    replay(ops, state, open);
    return open;
  }

  [[nodiscard]] State after(const std::vector<Op>& ops, State state) const {
    Barrier ignored;
    replay(ops, state, ignored);
    return state;
  }

  static void close(std::vector<Op>& phase, Bits bits) {
    if (bits == 0) return;
    if (phase.empty() || !std::holds_alternative<Barrier>(phase.back().what)) phase.emplace_back().what = Barrier{};
    std::get<Barrier>(phase.back().what).bits |= bits;
  }

  // What the barriers leave open in any run.
  [[nodiscard]] Barrier missing() const {
    Barrier open = missing(plan_.setup, clean());
    for (const std::vector<Op>* phase : {&plan_.setup, &plan_.step, &plan_.frame}) {
      const State end = after(*phase, clean());
      for (const std::vector<Op>* next : {&plan_.step, &plan_.frame}) {
        State state = end;
        replay(*next, state, open);
      }
    }
    return open;
  }

  // Along one phase, with the states in which its ops are met in any run: what would be open if a barrier lacked some bits. Nothing
  // is open while it has them, so only what follows it counts, up to where other barriers have closed those bits.
  class Walk {
   public:
    Walk(const Placement& placement, const std::vector<Op>& phase) : placement_(placement), phase_(phase) { start(); }

    void go_to(std::size_t op) {
      Barrier ignored;
      for (State& state : states_) placement_.replay(std::span(phase_).subspan(at_, op - at_), state, ignored);
      at_ = op;
    }
    // `bits` have been taken from a barrier of the op reached.
    Barrier open_without(Bits bits) {
      if (reach_the_end(bits)) return placement_.missing();
      Barrier open;
      for (State& state : states_) {
        state.begin_trial();
        placement_.replay(std::span(phase_).subspan(at_), state, open, bits);
        state.end_trial();
      }
      return open;
    }
    // They stay away.
    void drop(Bits bits) {
      if (!reach_the_end(bits)) return;
      const std::size_t here = std::exchange(at_, 0);
      start();
      go_to(here);
    }

   private:
    void start() {
      states_.clear();
      const Plan& plan = placement_.plan_;
      if (&phase_ == &plan.setup) states_.push_back(placement_.clean());
      if (&phase_ != &plan.setup)
        for (const std::vector<Op>* before : {&plan.setup, &plan.step, &plan.frame})
          states_.push_back(placement_.after(*before, placement_.clean()));
    }
    // What they leave open is not closed in this phase for sure.
    [[nodiscard]] bool reach_the_end(Bits bits) const {
      for (std::size_t op = at_ + 1; op < phase_.size() && bits != 0; ++op)
        if (const auto* barrier = std::get_if<Barrier>(&phase_[op].what)) bits &= ~barrier->bits;
      return bits != 0;
    }

    const Placement& placement_;
    const std::vector<Op>& phase_;
    std::vector<State> states_;
    std::size_t at_ = 0;
  };

  static void each_barrier(Op& op, const std::function<void(Barrier&)>& visit) {
    if (auto* repeat = std::get_if<Repeat>(&op.what))
      for (Op& inner : repeat->body) each_barrier(inner, visit);
    if (auto* barrier = std::get_if<Barrier>(&op.what)) visit(*barrier);
  }

  static void each_barrier_of(const Placement& placement, std::vector<Op>& phase,
                              const std::function<void(Barrier&, Walk&)>& visit) {
    Walk walk(placement, phase);
    for (std::size_t op = 0; op < phase.size(); ++op) {
      walk.go_to(op);
      each_barrier(phase[op], [&](Barrier& barrier) { visit(barrier, walk); });
    }
  }

  static void erase_empty_barriers(std::vector<Op>& ops) {
    for (Op& op : ops)
      if (auto* repeat = std::get_if<Repeat>(&op.what)) erase_empty_barriers(repeat->body);
    std::erase_if(ops, [](const Op& op) {
      const auto* barrier = std::get_if<Barrier>(&op.what);
      return barrier != nullptr && barrier->bits == 0;
    });
  }

  void drop_needless_bits(std::vector<Op>& phase) {
    each_barrier_of(*this, phase, [](Barrier& barrier, Walk& walk) {
      for (const auto& [bit, bit_name] : bit_table) {
        if ((barrier.bits & bit) == 0) continue;
        barrier.bits &= ~bit;
        if (walk.open_without(bit).bits != 0)
          barrier.bits |= bit;
        else
          walk.drop(bit);
      }
    });
    erase_empty_barriers(phase);
  }

  // A barrier's reasons are what would be open without it.
  void give_reasons(std::vector<Op>& phase) {
    each_barrier_of(*this, phase, [](Barrier& barrier, Walk& walk) {
      const Bits bits = std::exchange(barrier.bits, 0);
      barrier = {bits, walk.open_without(bits).reasons};
    });
  }

  Plan& plan_;
};

}  // namespace

std::vector<std::string> bit_names(Bits bits) {
  std::vector<std::string> names;
  for (const auto& [bit, name] : bit_table)
    if ((bits & bit) != 0) names.emplace_back(name);
  return names;
}

Bits consumer_bit(Usage usage, bool texture) {
  if (usage == Usage::transfer || usage == Usage::host) return texture ? bit_texture_update : bit_buffer_update;
  constexpr std::array<std::pair<Usage, Bit>, 7> bits{{{Usage::storage, bit_shader_storage},
                                                       {Usage::uniform, bit_uniform},
                                                       {Usage::sampled, bit_texture_fetch},
                                                       {Usage::image, bit_shader_image_access},
                                                       {Usage::vertex, bit_vertex_attrib_array},
                                                       {Usage::indirect, bit_command},
                                                       {Usage::framebuffer, bit_framebuffer}}};
  return std::ranges::find(bits, usage, &std::pair<Usage, Bit>::first)->second;
}

bool is_shader_write(const BufferAccess& access) {
  return writes(access.access) && (access.usage == Usage::storage || access.usage == Usage::image);
}

void place_barriers(Plan& plan) { Placement(plan).run(); }

}  // namespace firn::graph
