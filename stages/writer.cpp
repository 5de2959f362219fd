#include "stages/writer.h"

#include <spdlog/spdlog.h>

namespace firn::stages {

Writer::~Writer() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  if (!error_ || told_) return;
  try {
    std::rethrow_exception(error_);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
  }
}

void Writer::add(std::size_t bytes, std::function<void()> job) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return jobs_.empty() || error_ || waiting_ + bytes <= most_waiting_; });
  tell(lock);
  jobs_.push_back({bytes, std::move(job)});
  waiting_ += bytes;
  if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
  changed_.notify_all();
}

void Writer::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return jobs_.empty(); });
  tell(lock);
}

void Writer::tell(std::unique_lock<std::mutex>& lock) {
  if (!error_) return;
  told_ = true;
  const std::exception_ptr error = error_;
  lock.unlock();
  std::rethrow_exception(error);
}

void Writer::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return !jobs_.empty() || ending_; });
    if (jobs_.empty()) return;
    const bool wanted = !error_;
    std::function<void()> run = std::move(jobs_.front().run);
    lock.unlock();
    std::exception_ptr error;
    try {
      if (wanted) run();
    } catch (...) {
      error = std::current_exception();
    }
    run = nullptr;  // what it held is freed before its bytes are
    lock.lock();
    if (error) error_ = error;
    waiting_ -= jobs_.front().bytes;
    jobs_.pop_front();
    changed_.notify_all();
  }
}

}  // namespace firn::stages
