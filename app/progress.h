#pragma once

// How far a run is: a bar on a terminal, a plain line now and then elsewhere. On stderr.

#include <chrono>
#include <cstdint>

namespace firn::app {

class Progress {
 public:
  // `total`: what is to be done, in the unit of update(). Silent where `quiet`. A run that goes on has something of it behind it.
  Progress(double total, bool quiet, double done_before = 0, std::uint64_t steps_before = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(double done, std::uint64_t frame, std::uint64_t step);
  // Ends the display with what the last update() said, whenever that was shown.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void print(double done, std::uint64_t frame, std::uint64_t step);

  double total_, done_before_;
  std::uint64_t steps_before_;
  bool quiet_, terminal_;
  struct Update {
    double done = 0;
    std::uint64_t frame = 0, step = 0;
    bool shown = true;
  };
  Update newest_;
  bool line_is_open_ = false;
  Clock::time_point start_ = Clock::now(), last_ = start_ - std::chrono::hours(1);
};

}  // namespace firn::app
