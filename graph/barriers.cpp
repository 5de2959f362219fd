#include "graph/barriers.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "graph/barrier_needs.h"

namespace firn::graph {
namespace {

constexpr std::array<std::pair<Bit, const char*>, 11> bit_table{{
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
constexpr Bits every_bit = (1u << 11) - 1;
constexpr Bits write_bits = bit_shader_storage | bit_shader_image_access;  // the bits that later shader writes wait at

// What is open for one storage at one point of the execution; buffers that share it count as one. Accumulations are kept apart:
// among themselves they need no order.
struct BufferState {
  Bits stale = 0;              // consumers that may not see the last shader write yet
  Bits stale_accumulated = 0;  // the same after accumulation
  Bits unordered = 0;          // write bits at which earlier accesses have not been waited for yet
  Bits unordered_accumulated = 0;

  void clear(Bits bits) {
    stale &= ~bits;
    stale_accumulated &= ~bits;
    unordered &= ~bits;
    unordered_accumulated &= ~bits;
  }
  [[nodiscard]] std::array<Bits, 4> hazards() const { return {stale, stale_accumulated, unordered, unordered_accumulated}; }
};

struct State {
  std::vector<BufferState> buffers;

  void barrier(Bits bits) {
    for (BufferState& buffer : buffers) buffer.clear(bits);
  }
  // Takes in what is open after another way to the same point. True where that adds anything.
  bool join(const State& other) {
    bool grown = false;
    for (std::size_t b = 0; b < buffers.size(); ++b) {
      BufferState& mine = buffers[b];
      const BufferState& theirs = other.buffers[b];
      const auto before = mine.hazards();
      mine.stale |= theirs.stale;
      mine.stale_accumulated |= theirs.stale_accumulated;
      mine.unordered |= theirs.unordered;
      mine.unordered_accumulated |= theirs.unordered_accumulated;
      grown |= before != mine.hazards();
    }
    return grown;
  }
};

// Replaying ops distributes over joins of states: what is open at the end is what the ops leave open themselves, and what was open
// before and not closed by their barriers. So pairs of phases are enough to look at; longer ways leave no more open than these.
class Placement {
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
      for (const std::vector<Op>* next : {&plan_.step, &plan_.frame}) close(*phase, missing(*next, after(*phase, clean())));

    // Barriers that came later can make earlier ones superfluous, round a loop or where a phase was closed. Steps come first: they
    // run most.
    drop_needless_bits();
    for (std::vector<Op>* phase : {&plan_.setup, &plan_.step, &plan_.frame}) erase_empty(*phase);
    give_reasons();
  }

 private:
  using Body = std::function<std::vector<Op>(State&)>;

  [[nodiscard]] State clean() const { return State{std::vector<BufferState>(plan_.buffers.size())}; }

  [[nodiscard]] Bits access_bit(const BufferAccess& access) const {
    return consumer_bit(access.usage, plan_.buffers[static_cast<std::size_t>(access.buffer)].texture);
  }

  [[nodiscard]] std::size_t storage(const BufferAccess& access) const {
    return static_cast<std::size_t>(plan_.buffers[static_cast<std::size_t>(access.buffer)].storage);
  }

  // The bits that one access waits for.
  [[nodiscard]] Bits need(const BufferAccess& access, const State& state) const {
    const BufferState& buffer = state.buffers[storage(access)];
    const bool accumulates = access.access == Access::accumulate;
    const Bits stale = buffer.stale | (accumulates ? 0 : buffer.stale_accumulated);
    const Bits unordered = buffer.unordered | (accumulates ? 0 : buffer.unordered_accumulated);
    return access_bit(access) & (stale | (is_shader_write(access) ? unordered : 0));
  }

  void apply(const BufferAccess& access, State& state) const {
    BufferState& buffer = state.buffers[storage(access)];
    const bool accumulates = access.access == Access::accumulate;
    if (is_shader_write(access)) (accumulates ? buffer.stale_accumulated : buffer.stale) = every_bit;
    // The API's own accesses are done, or ordered by OpenGL, when the next command starts.
    if (access.usage == Usage::host || access.usage == Usage::transfer) return;
    (accumulates ? buffer.unordered_accumulated : buffer.unordered) |= write_bits;
  }

  [[nodiscard]] Bits need_until(const Repeat& repeat, const State& state) const {
    const bool reads = repeat.until && repeat.until->progress < 0;
    return reads ? need({repeat.until->buffer, Access::read, Usage::transfer}, state) : 0;
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
        Bits bits = 0;
        for (const BufferAccess& access : run->accesses) bits |= need(access, state);
        place(bits, state, placed);
        for (const BufferAccess& access : run->accesses) apply(access, state);
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
          place(need_until(repeat, s), s, ops);
          return ops;
        },
        own);
    // What only the first turn needs stands before the loop.
    const Op op{planned};
    place(missing({op}, state), state, placed);
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

  // Runs planned ops; collects in `open` what their own barriers leave open.
  void replay(const std::vector<Op>& ops, State& state, Bits& open) const {
    for (const Op& op : ops) {
      if (const auto* barrier = std::get_if<Barrier>(&op.what)) {
        state.barrier(barrier->bits);
      } else if (const auto* run = std::get_if<Run>(&op.what)) {
        for (const BufferAccess& access : run->accesses) open |= need(access, state);
        for (const BufferAccess& access : run->accesses) apply(access, state);
      } else if (const auto* repeat = std::get_if<Repeat>(&op.what)) {
        // One turn may be all there is; the second stands for all later ones.
        replay(repeat->body, state, open);
        open |= need_until(*repeat, state);
        if (repeat->max == 1) continue;
        const State once = state;
        replay(repeat->body, state, open);
        open |= need_until(*repeat, state);
        state.join(once);
      }
    }
  }

  [[nodiscard]] Bits missing(const std::vector<Op>& ops, State state) const {
    Bits open = 0;
    replay(ops, state, open);
    return open;
  }

  [[nodiscard]] State after(const std::vector<Op>& ops, State state) const {
    Bits ignored = 0;
    replay(ops, state, ignored);
    return state;
  }

  static void close(std::vector<Op>& phase, Bits bits) {
    if (bits == 0) return;
    if (phase.empty() || !std::holds_alternative<Barrier>(phase.back().what)) phase.emplace_back().what = Barrier{};
    std::get<Barrier>(phase.back().what).bits |= bits;
  }

  struct SetBit {
    Barrier* barrier;
    Bits bit;
  };
  static void collect(std::vector<Op>& ops, std::vector<SetBit>& bits) {
    for (Op& op : ops) {
      if (auto* repeat = std::get_if<Repeat>(&op.what)) collect(repeat->body, bits);
      if (auto* barrier = std::get_if<Barrier>(&op.what))
        for (const auto& [bit, bit_name] : bit_table)
          if ((barrier->bits & bit) != 0) bits.push_back({barrier, bit});
    }
  }

  // One bit after the other, each if what is left then suffices. Whether so many can go together is the same question, so the
  // longest row of bits that can is sought by halves: a plan of n barriers is played a few times, not n times.
  void drop_needless_bits() {
    std::vector<SetBit> bits;
    for (std::vector<Op>* phase : {&plan_.step, &plan_.frame, &plan_.setup}) collect(*phase, bits);
    for (auto begin = bits.begin(); begin != bits.end();) {
      const BarrierNeeds needs = barrier_needs(plan_);
      begin = bits.erase(bits.begin(), begin);
      std::erase_if(bits, [&](const SetBit& set) {
        const auto need = needs.of.find(set.barrier);
        return need != needs.of.end() && (need->second.bits & set.bit) != 0;
      });
      begin = bits.begin();
      for (auto end = bits.end(); begin != end;) {
        const auto middle = begin + (end - begin + 1) / 2;
        for (auto set = begin; set != middle; ++set) set->barrier->bits &= ~set->bit;
        if (barrier_needs(plan_).complete) {
          begin = middle;
          continue;
        }
        for (auto set = begin; set != middle; ++set) set->barrier->bits |= set->bit;
        end = middle - 1;
      }
      if (begin != bits.end()) ++begin;  // this one is needed now
    }
  }

  static void erase_empty(std::vector<Op>& ops) {
    for (Op& op : ops)
      if (auto* repeat = std::get_if<Repeat>(&op.what)) erase_empty(repeat->body);
    std::erase_if(ops, [](const Op& op) {
      const auto* barrier = std::get_if<Barrier>(&op.what);
      return barrier != nullptr && barrier->bits == 0;
    });
  }

  void give_reasons() {
    BarrierNeeds needs = barrier_needs(plan_);
    const std::function<void(std::vector<Op>&)> give = [&](std::vector<Op>& ops) {
      for (Op& op : ops) {
        if (auto* repeat = std::get_if<Repeat>(&op.what)) give(repeat->body);
        if (auto* barrier = std::get_if<Barrier>(&op.what)) barrier->reasons = std::move(needs.of[barrier].reasons);
      }
    };
    for (std::vector<Op>* phase : {&plan_.step, &plan_.frame, &plan_.setup}) give(*phase);
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
