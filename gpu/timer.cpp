#include <algorithm>
#include <stdexcept>
#include <utility>

#include "gpu/commands.h"
#include "gpu/context.h"

namespace firn::gpu {

namespace {

std::uint64_t nanoseconds(GLuint query) {
  GLuint64 value = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &value);
  return value;
}

bool is_ready(GLuint query) {
  GLint available = 0;
  glGetQueryObjectiv(query, GL_QUERY_RESULT_AVAILABLE, &available);
  return available != 0;
}

}  // namespace

// Pairs of time stamps and not GL_TIME_ELAPSED: that cannot be nested, and Mesa's software renderer gives 0 for compute.
TimerRing::TimerRing(int slots) : slots_(std::max(slots, 1)) {
  Context& context = current();
  GLint bits = 0;
  glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
  if (!bits) throw DeviceError("the device keeps no time: its time stamps have 0 bits");
  for (Slot& slot : slots_) {
    glGenQueries(1, &slot.start);
    glGenQueries(1, &slot.stop);
  }
  GLint64 now = 0;
  glGetInteger64v(GL_TIMESTAMP, &now);
  made_ = static_cast<std::uint64_t>(now);
  context.check();
}

TimerRing::~TimerRing() {
  if (!current_or_null()) return;
  for (const Slot& slot : slots_) {
    glDeleteQueries(1, &slot.start);
    glDeleteQueries(1, &slot.stop);
  }
}

void TimerRing::begin(std::int64_t tag) {
  if (running_) throw std::logic_error("TimerRing::begin() before the end() of the work before");
  Context& context = current();
  if (head_ - tail_ == slots_.size()) take_finished(true);
  Slot& slot = slots_[head_ % slots_.size()];
  slot.tag = tag;
  glQueryCounter(slot.start, GL_TIMESTAMP);
  context.check_told();
  running_ = true;
}

void TimerRing::end() {
  if (!running_) throw std::logic_error("TimerRing::end() without begin()");
  Context& context = current();
  glQueryCounter(slots_[head_ % slots_.size()].stop, GL_TIMESTAMP);
  ++head_;
  running_ = false;
  context.check_told();
}

void TimerRing::take_finished(bool wait) {
  for (; tail_ < head_; ++tail_) {
    const Slot& slot = slots_[tail_ % slots_.size()];
    if (!wait && !is_ready(slot.stop)) return;
    const std::uint64_t start = nanoseconds(slot.start);
    const std::uint64_t stop = nanoseconds(slot.stop);
    const auto between = [](std::uint64_t from, std::uint64_t to) {
      return to > from ? 1e-9 * static_cast<double>(to - from) : 0.0;
    };
    done_.push_back({slot.tag, between(made_, start), between(start, stop)});
  }
}

std::vector<TimerRing::Sample> TimerRing::collect(bool wait) {
  Context& context = current();
  take_finished(wait);
  context.check_told();
  return std::exchange(done_, {});
}

}  // namespace firn::gpu
