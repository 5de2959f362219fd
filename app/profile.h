#pragma once

// Where the time of a step goes, pass by pass.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/load.h"
#include "app/profile_bytes.h"
#include "app/speed.h"

namespace firn::app {

struct ProfiledPass {
  std::string stage, doc, equation, work;
  std::string elements;         // what a launch works on, in words: "over nodes, 1000000", "over 31.5 groups of 64 on average"
  std::vector<double> seconds;  // one per launch
  std::vector<Traffic> traffic;
  std::optional<double> operations = {};  // additions and multiplications of a launch; none: its stage does not tell
  std::optional<double> groups = {};      // work groups of a launch, on average; none: it is no dispatch
  bool host = false;                      // on the processor: nothing to be said of bytes
  std::string left_out = {};              // why it is never launched: "there are no bodies"; empty: it is

  [[nodiscard]] double total() const;
  [[nodiscard]] double typical() const;  // s, of all launches if each took the median: one that was held up changes nothing
  [[nodiscard]] double bytes() const;
  [[nodiscard]] bool bytes_at_most() const;       // some of them may not be touched, and weigh more than a tenth
  [[nodiscard]] double bytes_per_second() const;  // of the median launch
  [[nodiscard]] std::optional<double> operations_per_second() const;
};

struct ProfiledLaunch {
  std::size_t pass = 0;
  std::uint64_t step = 0;         // from 0, the first that was timed
  double start = 0, seconds = 0;  // s since the first launch
};

// What holds a pass back.
struct Holder {
  std::string name;      // "bandwidth"
  std::string sentence;  // "it moves bytes at 83 % of the rate at which the device copies"
};

struct Profile {
  std::string pipeline, scene, device, clock;  // clock: which one the times are by, in words
  std::uint64_t steps = 0;
  double wall = 0;  // s per step, with everything between passes
  // How much longer a step takes because it is timed, 0.01 is 1 %: of blocks of steps with and without in turn the median, and what
  // half of them lie between.
  struct Cost {
    double median = 0, low = 0, high = 0;
    std::size_t pairs = 0;
  };
  std::optional<Cost> cost;
  Speed speed;    // of the device
  int units = 0;  // that work on groups at once; 0: not known
  std::vector<ProfiledPass> passes;
  std::vector<ProfiledLaunch> launches;

  [[nodiscard]] double total() const;                                  // s, of all launches
  [[nodiscard]] double share_of_time(const ProfiledPass& pass) const;  // by the medians of all passes
  [[nodiscard]] double share_of_copy(const ProfiledPass& pass) const;
  [[nodiscard]] std::optional<double> share_of_arithmetic(const ProfiledPass& pass) const;
  // The nearer of the two: no pass can be done in less than this share of its time, unless caches hold what it works on. None on
  // the processor, and where it is never launched.
  struct Bound {
    double share = 0;
    bool by_bytes = true, at_most = false;
  };
  [[nodiscard]] std::optional<Bound> bound(const ProfiledPass& pass) const;
  [[nodiscard]] Holder held_back_by(const ProfiledPass& pass) const;
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
