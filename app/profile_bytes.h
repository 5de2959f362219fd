#pragma once

// How many bytes the launches of a pass touch.

#include <map>
#include <optional>
#include <vector>

#include "graph/execution/execution.h"

namespace firn::app {

// One buffer as one launch touches it: every element that it works on read or written once, however often it comes back to it.
struct Traffic {
  std::string buffer, access, usage;
  double read = 0, written = 0;  // bytes
  bool at_most = false;          // which of the elements are touched only the kernel knows
  bool scattered = false;        // its elements are found by number: they are not those that the kernel's invocations stand for
};

// Groups of indirect dispatches, as steps have counted them.
class GroupCounts {
 public:
  void add(const graph::Plan& plan, const std::vector<execution::PassGroups>& groups);
  [[nodiscard]] std::optional<double> of(const graph::Run& run) const;  // mean of its launches; none: it is not indirect
  // The mean number of groups of all dispatches by a port of `stage` (-1: of any stage) that stands for the list over `domain`.
  [[nodiscard]] std::optional<double> by_list(const graph::Plan& plan, int stage, const std::string& domain) const;

 private:
  struct Mean {
    double sum = 0;
    int count = 0;
    [[nodiscard]] std::optional<double> value() const { return count > 0 ? std::optional(sum / count) : std::nullopt; }
  };
  std::map<std::pair<int, int>, Mean> by_work_;
  std::map<int, Mean> by_buffer_;  // that holds the groups
};

std::vector<Traffic> traffic_of(const graph::Plan& plan, const graph::Run& run, const GroupCounts& groups);

}  // namespace firn::app
