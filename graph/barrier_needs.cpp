#include "graph/barrier_needs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "graph/barriers.h"

namespace firn::graph {
namespace {

// Ways in which a storage can be open, as in barriers.cpp: consumers that may not see the last write, and accesses that a write
// may overtake; those of accumulations apart, which need no order among themselves.
enum Way : std::uint8_t { stale, stale_accumulated, unordered, unordered_accumulated };
constexpr std::array<Way, 4> every_way{stale, stale_accumulated, unordered, unordered_accumulated};

// Open were it not for one barrier: only that one lies between the earlier access and here.
struct Closed {
  Way way;
  Bits bit;  // one bit
  const Barrier* by;
  bool operator==(const Closed&) const = default;
};

struct StorageState {
  std::array<Bits, 4> open{};
  std::vector<Closed> closed;
  struct Last {
    int stage = -1;
    Access access = Access::read;
    int buffer = -1;
  };
  Last written, accessed;

  void set_open(Way way, Bits bits) {
    open.at(way) |= bits;
    std::erase_if(closed, [&](const Closed& c) { return c.way == way && (c.bit & bits) != 0; });
  }

  void barrier(const Barrier& barrier) {
    std::erase_if(closed, [&](const Closed& c) { return (c.bit & barrier.bits) != 0 && c.by != &barrier; });
    for (const Way way : every_way) {
      for (Bits rest = open.at(way) & barrier.bits; rest != 0; rest &= rest - 1) closed.push_back({way, rest & -rest, &barrier});
      open.at(way) &= ~barrier.bits;
    }
  }

  void join(const StorageState& other) {
    for (const Way way : every_way) set_open(way, other.open.at(way));
    for (const Closed& c : other.closed)
      if ((open.at(c.way) & c.bit) == 0 && std::ranges::find(closed, c) == closed.end()) closed.push_back(c);
    if (written.stage < 0) written = other.written;
    if (accessed.stage < 0) accessed = other.accessed;
  }
};
using State = std::vector<StorageState>;

class Replay {
 public:
  explicit Replay(const Plan& plan) : plan_(plan) {}

  BarrierNeeds run() {
    State state = clean();
    told_ = true;
    ops(plan_.setup, state);
    for (const std::vector<Op>* phase : {&plan_.setup, &plan_.step, &plan_.frame}) {
      // From a clean start a phase leaves nothing open that the pairs would not tell of.
      State end = clean();
      told_ = false;
      ops(*phase, end);
      told_ = true;
      for (const std::vector<Op>* next : {&plan_.step, &plan_.frame}) {
        state = end;
        ops(*next, state);
      }
    }
    return std::move(needs_);
  }

 private:
  [[nodiscard]] State clean() const { return State(plan_.buffers.size()); }
  [[nodiscard]] const PlannedBuffer& buffer(int index) const { return plan_.buffers[static_cast<std::size_t>(index)]; }
  [[nodiscard]] const std::string& label(int stage) const { return plan_.stages[static_cast<std::size_t>(stage)].label; }

  void ops(const std::vector<Op>& list, State& state) {
    for (const Op& op : list) {
      if (const auto* barrier = std::get_if<Barrier>(&op.what)) {
        if (barrier->bits == 0) continue;
        for (StorageState& storage : state) storage.barrier(*barrier);
      } else if (const auto* run = std::get_if<Run>(&op.what)) {
        for (const BufferAccess& access : run->accesses) need(access, label(run->stage), state);
        for (const BufferAccess& access : run->accesses) apply(access, run->stage, state);
      } else if (const auto* repeat = std::get_if<Repeat>(&op.what)) {
        // One turn may be all there is; the second stands for all later ones.
        turn(*repeat, state);
        if (repeat->max == 1) continue;
        const State once = state;
        turn(*repeat, state);
        for (std::size_t s = 0; s < state.size(); ++s) state[s].join(once[s]);
      }
    }
  }

  void turn(const Repeat& repeat, State& state) {
    ops(repeat.body, state);
    if (repeat.until && repeat.until->progress < 0)
      need({repeat.until->buffer, Access::read, Usage::transfer}, "the end of the repeat", state);
  }

  void need(const BufferAccess& access, const std::string& who, const State& state) {
    if (!told_) return;
    const StorageState& storage = state[static_cast<std::size_t>(buffer(access.buffer).storage)];
    const Bits bit = consumer_bit(access.usage, buffer(access.buffer).texture);
    const bool accumulates = access.access == Access::accumulate, stores = is_shader_write(access);
    const auto matters = [&](Way way) {
      if (accumulates && (way == stale_accumulated || way == unordered_accumulated)) return false;
      return stores || way == stale || way == stale_accumulated;
    };
    for (const Way way : every_way)
      if (matters(way) && (storage.open.at(way) & bit) != 0) needs_.complete = false;
    for (const Closed& c : storage.closed) {
      if (!matters(c.way) || c.bit != bit) continue;
      const bool sees_old = std::ranges::any_of(storage.closed, [&](const Closed& other) {
        return other.by == c.by && other.bit == bit && matters(other.way) && (other.way == stale || other.way == stale_accumulated);
      });
      BarrierNeed& need = needs_.of[c.by];
      need.bits |= bit;
      std::string reason = reason_of(access, who, sees_old ? storage.written : storage.accessed);
      if (std::ranges::find(need.reasons, reason) == need.reasons.end()) need.reasons.push_back(std::move(reason));
    }
  }

  [[nodiscard]] std::string reason_of(const BufferAccess& access, const std::string& who, const StorageState::Last& earlier) const {
    const auto verb = [](Access how) {
      return how == Access::read ? "read" : how == Access::accumulate ? "accumulated" : "written";
    };
    const std::string shared =
        earlier.buffer == access.buffer ? "" : fmt::format(", in memory that was {}'s", buffer(earlier.buffer).name);
    return fmt::format("{}{}: {} by {}, {} by {}", buffer(access.buffer).name, shared, verb(earlier.access), label(earlier.stage),
                       verb(access.access), who);
  }

  void apply(const BufferAccess& access, int stage, State& state) const {
    constexpr Bits every_bit = (1u << 11) - 1;
    constexpr Bits write_bits = bit_shader_storage | bit_shader_image_access;
    StorageState& storage = state[static_cast<std::size_t>(buffer(access.buffer).storage)];
    const bool accumulates = access.access == Access::accumulate;
    if (is_shader_write(access)) {
      storage.set_open(accumulates ? stale_accumulated : stale, every_bit);
      storage.written = {stage, access.access, access.buffer};
    }
    if (access.usage == Usage::host || access.usage == Usage::transfer) return;
    storage.set_open(accumulates ? unordered_accumulated : unordered, write_bits);
    storage.accessed = {stage, access.access, access.buffer};
  }

  const Plan& plan_;
  BarrierNeeds needs_;
  bool told_ = true;
};

}  // namespace

BarrierNeeds barrier_needs(const Plan& plan) { return Replay(plan).run(); }

}  // namespace firn::graph
