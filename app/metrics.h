#pragma once

// metrics.csv: one line per frame, about the state as a whole.

#include <array>
#include <chrono>
#include <filesystem>
#include <memory>

#include "app/files.h"
#include "app/load.h"
#include "graph/execution/execution.h"

namespace firn::app {

class Metrics {
 public:
  // Columns depend on what the plan has: particles, a height field. Lines of an earlier process that
  // lie at or after the start's frame are dropped.
  Metrics(const std::filesystem::path& run, const Loaded& loaded, const graph::Clock& start);

  // Adds a line about the frame that was just drawn, or throws std::runtime_error. Waits for the device.
  void add(execution::Execution& execution);
  [[nodiscard]] double seconds() const { return seconds_; }  // that all lines took

 private:
  [[nodiscard]] std::string particles(const execution::Execution& execution) const;
  [[nodiscard]] static std::string flow(const execution::Execution& execution);
  [[nodiscard]] std::string field(const execution::Execution& execution) const;

  std::unique_ptr<LineFile> file_;
  bool has_particles_ = false, has_flow_ = false, has_field_ = false;
  std::array<double, 3> gravity_{};
  double cell_area_ = 0;  // m2, of the field
  std::uint64_t step_before_ = 0;
  std::chrono::steady_clock::time_point time_before_ = std::chrono::steady_clock::now();
  double seconds_ = 0;
};

// The hash of such a file without its last column, steps_per_second, which is no result of the simulation.
std::string hash_of_metrics(const std::filesystem::path& file);

}  // namespace firn::app
