#include "graph/barrier_state.h"

#include <algorithm>

namespace firn::graph {

void StorageState::clear(Bits bits) {
  stale &= ~bits;
  stale_accumulated &= ~bits;
  unordered &= ~bits;
  unordered_accumulated &= ~bits;
}

void MemoryState::barrier(Bits bits) {
  ++barriers_;
  for (std::size_t bit = 0; bit < bit_count; ++bit)
    if ((bits >> bit & 1u) != 0) last_[bit] = barriers_;
}

Bits MemoryState::closed_since(std::uint64_t barrier) const {
  Bits closed = 0;
  if (barrier < barriers_)
    for (std::size_t bit = 0; bit < bit_count; ++bit)
      if (last_[bit] > barrier) closed |= 1u << bit;
  return closed;
}

StorageState MemoryState::at(std::size_t storage) const {
  StorageState state = storages_[storage];
  state.clear(closed_since(state.as_of));
  state.as_of = barriers_;
  return state;
}

StorageState& MemoryState::change(std::size_t storage) {
  StorageState& state = storages_[storage];
  if (trial_.on) trial_.before.emplace_back(storage, state);
  state.clear(closed_since(state.as_of));
  state.as_of = barriers_;
  return state;
}

bool MemoryState::join(const MemoryState& other) {
  bool grown = false;
  for (std::size_t s = 0; s < storages_.size(); ++s) {
    StorageState mine = at(s);
    const StorageState theirs = other.at(s);
    const auto before = mine.hazards();
    mine.stale |= theirs.stale;
    mine.stale_accumulated |= theirs.stale_accumulated;
    mine.unordered |= theirs.unordered;
    mine.unordered_accumulated |= theirs.unordered_accumulated;
    if (mine.written.stage < 0) mine.written = theirs.written;
    if (mine.accessed.stage < 0) mine.accessed = theirs.accessed;
    grown |= before != mine.hazards();
    change(s) = mine;
  }
  return grown;
}

void MemoryState::begin_trial() {
  trial_.on = true;
  trial_.barriers = barriers_;
  trial_.last = last_;
}

void MemoryState::end_trial() {
  for (auto change = trial_.before.rbegin(); change != trial_.before.rend(); ++change) storages_[change->first] = change->second;
  trial_.before.clear();
  barriers_ = trial_.barriers;
  last_ = trial_.last;
  trial_.on = false;
}

}  // namespace firn::graph
