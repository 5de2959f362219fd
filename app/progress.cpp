#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace firn::app {
namespace {

std::string clock_text(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  return whole >= 3600 ? fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
                       : fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

Progress::Progress(double total, bool quiet, double done_before, std::uint64_t steps_before)
    : total_(total), done_before_(done_before), steps_before_(steps_before), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() { finish(); }

void Progress::update(double done, std::uint64_t frame, std::uint64_t step) {
  if (quiet_) return;
  newest_ = {done, frame, step, false};
  const auto now = Clock::now();
  if (now - last_ < (terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000))) return;
  last_ = now;
  print(done, frame, step);
  newest_.shown = true;
}

void Progress::print(double done, std::uint64_t frame, std::uint64_t step) {
  const double share = total_ > 0 ? std::clamp(done / total_, 0.0, 1.0) : 1.0;
  const double passed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double rate = passed > 0 ? static_cast<double>(step - steps_before_) / passed : 0;
  const double share_now = total_ > done_before_ ? std::clamp((done - done_before_) / (total_ - done_before_), 0.0, 1.0) : 1.0;
  const std::string left = share >= 1                    ? "0:00"
                           : share_now > 0 && passed > 2 ? clock_text(passed * (1 - share_now) / share_now)
                                                         : "?";
  if (terminal_) {
    constexpr int width = 30;
    const auto filled = static_cast<std::size_t>(share * width);
    fmt::print(stderr, "\r[{}{}] {:3.0f} %  frame {}  step {}  {:.0f} steps/s  {} left \033[K", std::string(filled, '='),
               std::string(width - filled, ' '), 100 * share, frame, step, rate, left);
    line_is_open_ = true;
  } else {
    fmt::print(stderr, "{:3.0f} %  frame {}  step {}  {:.0f} steps/s  {} left\n", 100 * share, frame, step, rate, left);
  }
}

void Progress::finish() {
  if (!newest_.shown) print(newest_.done, newest_.frame, newest_.step);
  newest_.shown = true;
  if (line_is_open_) fmt::print(stderr, "\n");
  line_is_open_ = false;
}

}  // namespace firn::app
