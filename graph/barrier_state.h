#pragma once

// What memory accesses have left open at one point of an execution, for the placement of barriers.

#include <array>
#include <utility>
#include <vector>

#include "graph/plan.h"

namespace firn::graph {

inline constexpr std::size_t bit_count = 11;  // of a barrier

// What is open for one storage; buffers that share it count as one. Accumulations are kept apart: among themselves they need no
// order.
struct StorageState {
  Bits stale = 0;              // consumers that may not see the last shader write yet
  Bits stale_accumulated = 0;  // the same after accumulation
  Bits unordered = 0;          // write bits at which earlier accesses have not been waited for yet
  Bits unordered_accumulated = 0;
  struct Last {
    int stage = -1;
    Access access = Access::read;
    int buffer = -1;
  };
  Last written, accessed;   // for the reasons only
  std::uint64_t as_of = 0;  // barriers up to this one have been taken in

  void clear(Bits bits);
  [[nodiscard]] std::array<Bits, 4> hazards() const { return {stale, stale_accumulated, unordered, unordered_accumulated}; }
};

// Of all storages. A barrier costs the same however many there are: each storage takes it in when it is looked at.
class MemoryState {
 public:
  explicit MemoryState(std::size_t storages) : storages_(storages) {}

  void barrier(Bits bits);
  [[nodiscard]] StorageState at(std::size_t storage) const;
  StorageState& change(std::size_t storage);
  // Takes in what is open after another way to the same point. True where that adds anything.
  bool join(const MemoryState& other);

  // What is done from begin_trial() on is undone by end_trial(). One at a time; a copy begins none.
  void begin_trial();
  void end_trial();

 private:
  [[nodiscard]] Bits closed_since(std::uint64_t barrier) const;

  std::vector<StorageState> storages_;
  std::uint64_t barriers_ = 0;                   // so many so far
  std::array<std::uint64_t, bit_count> last_{};  // by bit: the last barrier that had it
  struct Trial {
    bool on = false;
    std::uint64_t barriers = 0;
    std::array<std::uint64_t, bit_count> last{};
    std::vector<std::pair<std::size_t, StorageState>> before;
  } trial_;
};

}  // namespace firn::graph
