#pragma once

// Calls of OpenGL, counted: what a step costs in calls is seen without a clock.

#include <cstdint>
#include <map>
#include <string>

namespace firn::gpu {

// Counts from its making to its end, the calls of all threads. One at a time, and no device is opened meanwhile.
class CallCounter {
 public:
  CallCounter();
  ~CallCounter();
  CallCounter(const CallCounter&) = delete;
  CallCounter& operator=(const CallCounter&) = delete;

  // By name; those since the last take().
  static std::map<std::string, std::uint64_t> take();
};

// Whether a call asks something of the device or waits for it.
bool is_query(const std::string& call);

}  // namespace firn::gpu
