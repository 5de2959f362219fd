#pragma once

// Where the time of a step goes, pass by pass.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/load.h"
#include "app/speed.h"
#include "graph/execution/execution.h"

namespace firn::app {

// One buffer as one launch touches it: as if every element were read or written once. Kernels that skip some do with less, those
// that come back to some need more.
struct Traffic {
  std::string buffer, access, usage;
  double read = 0, written = 0;  // bytes
};

struct ProfiledPass {
  std::string stage, doc, equation, work;
  std::string elements;         // what a launch works on, in words: "over nodes, 1000000", "over 31 groups of 64, read back once"
  std::vector<double> seconds;  // one per launch
  std::vector<Traffic> traffic;
  bool host = false;                      // on the processor: nothing to be said of bytes
  std::optional<double> operations = {};  // additions and multiplications of a launch; none: its stage does not tell

  [[nodiscard]] double total() const;
  [[nodiscard]] double bytes() const;
  [[nodiscard]] double bytes_per_second() const;  // of the median launch
  [[nodiscard]] std::optional<double> operations_per_second() const;
};

struct ProfiledLaunch {
  std::size_t pass = 0;
  std::uint64_t step = 0;         // from 0, the first that was timed
  double start = 0, seconds = 0;  // s since the first launch
};

struct Profile {
  std::string pipeline, scene, device, clock;  // clock: which one the times are by, in words
  std::uint64_t steps = 0;
  double wall = 0;             // s per step, with everything between passes
  std::optional<double> cost;  // how much longer a step takes because it is timed: 0.01 is 1 %
  Speed speed;                 // of the device
  std::vector<ProfiledPass> passes;
  std::vector<ProfiledLaunch> launches;

  [[nodiscard]] double total() const;  // s, of all launches
  [[nodiscard]] double share_of_copy(const ProfiledPass& pass) const;
  [[nodiscard]] std::optional<double> share_of_arithmetic(const ProfiledPass& pass) const;
  // "launching": no longer than two launches of an empty kernel; "bytes": 0.6 to 1.1 of the device's bandwidth; "arithmetic": at
  // least 0.6 of its arithmetic rate; "unclear": more than all of the bandwidth, so that caches hold what it works on, or not all
  // of it is touched; "its own work": atomics, waiting, bytes read more than once, invocations without work; "the processor".
  [[nodiscard]] std::string held_back_by(const ProfiledPass& pass) const;
};

struct ProfileRequest {
  std::uint64_t steps = 200, warm_up = 50;
  bool cost = false;
};
Profile run_profile(const Loaded& loaded, gpu::Device& device, const ProfileRequest& request);

std::string as_table(const Profile& profile);
nlohmann::json as_json(const Profile& profile);
nlohmann::json as_trace(const Profile& profile);  // for chrome://tracing, Perfetto and others: "trace event format"
std::string as_page(const Profile& profile);      // HTML that needs nothing else

}  // namespace firn::app
