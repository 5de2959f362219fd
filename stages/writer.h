#pragma once

// Files written in the background, so that the simulation goes on meanwhile.

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace firn::stages {

// Jobs run one after another in the order they came, on one thread that starts with the first. None is ever left out: where they
// come faster than they are done, add() waits. Once a job has failed, later ones are not run.
class Writer {
 public:
  // `most_waiting`: bytes that waiting jobs may hold together; a larger job waits until it is alone.
  explicit Writer(std::size_t most_waiting = std::size_t{512} << 20) : most_waiting_(most_waiting) {}
  ~Writer();  // does what is waiting; an error that nobody was told is logged
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  // Both throw what a job threw.
  void add(std::size_t bytes, std::function<void()> job);
  void finish();  // returns when nothing is waiting

 private:
  struct Job {
    std::size_t bytes;
    std::function<void()> run;
  };
  void work();
  void tell(std::unique_lock<std::mutex>& lock);

  std::size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;  // the first is being done
  std::size_t waiting_ = 0;
  std::exception_ptr error_;
  bool told_ = false, ending_ = false;
  std::thread thread_;
};

}  // namespace firn::stages
