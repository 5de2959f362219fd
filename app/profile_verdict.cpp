// What a profile says of its passes.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "app/profile.h"
#include "app/statistics.h"
#include "stages/listed.h"

namespace firn::app {
namespace {

constexpr double near_bound = 0.6;     // of what the device can do at most
constexpr double beyond_bound = 1.1;   // what no measurement's noise explains
constexpr double worth_a_word = 0.05;  // of a pass's bytes

std::vector<std::string> buffers(const ProfiledPass& pass, const std::function<bool(const Traffic&)>& wanted) {
  std::vector<std::string> names;
  for (const Traffic& one : pass.traffic)
    if (wanted(one) && one.read + one.written >= worth_a_word * pass.bytes()) names.push_back(one.buffer);
  return names;
}

// "a, b and 2 more"
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 3;
  const auto shown = static_cast<std::ptrdiff_t>(std::min(names.size(), most));
  const std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + shown, ", "));
  return names.size() > most ? fmt::format("{} and {} more", text, names.size() - most) : text;
}

std::string percent(double share) { return fmt::format("{:.0f} %", 100 * share); }

// Where neither bytes nor arithmetic nor launching explain the time.
Holder by_its_own_work(const Profile& profile, const ProfiledPass& pass) {
  const std::optional<double> arithmetic = profile.share_of_arithmetic(pass);
  const std::string known = fmt::format("{}{} of the time would do for its bytes{}", pass.bytes_at_most() ? "at most " : "",
                                        percent(profile.share_of_copy(pass)),
                                        arithmetic ? fmt::format(", {} for its arithmetic", percent(*arithmetic)) : "");
  if (profile.units > 0 && pass.groups && *pass.groups < profile.units)
    return {"too few elements", fmt::format("{:.3g} work groups leave some of the device's {} units without work; {}", *pass.groups,
                                            profile.units, known)};
  if (const auto sums = buffers(pass, [](const Traffic& one) { return one.access == "accumulate"; }); !sums.empty())
    return {"atomic sums", fmt::format("it adds to {} by atomics, in any order; {}", listed(sums), known)};
  const auto scattered = buffers(pass, [](const Traffic& one) { return one.scattered && one.read > 0; });
  if (!scattered.empty())
    return {"scattered reads",
            fmt::format("it reads {} by number, at scattered places or again and again; {}", listed(scattered), known)};
  return {"its own work", fmt::format("branches, roots, waiting and invocations without work are left; {}", known)};
}

}  // namespace

double ProfiledPass::total() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }

double ProfiledPass::typical() const { return median(seconds) * static_cast<double>(seconds.size()); }

double ProfiledPass::bytes() const {
  double sum = 0;
  for (const Traffic& one : traffic) sum += one.read + one.written;
  return sum;
}

bool ProfiledPass::bytes_at_most() const {
  double sure = 0;
  for (const Traffic& one : traffic)
    if (!one.at_most) sure += one.read + one.written;
  return sure < 0.9 * bytes();
}

double ProfiledPass::bytes_per_second() const {
  const double middle = median(seconds);
  return middle > 0 && !host ? bytes() / middle : 0;
}

std::optional<double> ProfiledPass::operations_per_second() const {
  const double middle = median(seconds);
  return operations && middle > 0 ? std::optional(*operations / middle) : std::nullopt;
}

double Profile::share_of_copy(const ProfiledPass& pass) const {
  return speed.bandwidth() > 0 ? pass.bytes_per_second() / speed.bandwidth() : 0;
}

std::optional<double> Profile::share_of_arithmetic(const ProfiledPass& pass) const {
  const std::optional<double> rate = pass.operations_per_second();
  return rate && speed.multiply_add > 0 ? std::optional(*rate / speed.multiply_add) : std::nullopt;
}

double Profile::total() const {
  double sum = 0;
  for (const ProfiledPass& pass : passes) sum += pass.total();
  return sum;
}

double Profile::share_of_time(const ProfiledPass& pass) const {
  double sum = 0;
  for (const ProfiledPass& each : passes) sum += each.typical();
  return sum > 0 ? pass.typical() / sum : 0;
}

std::optional<Profile::Bound> Profile::bound(const ProfiledPass& pass) const {
  if (pass.host || !pass.left_out.empty()) return std::nullopt;
  const double bytes = share_of_copy(pass), arithmetic = share_of_arithmetic(pass).value_or(0);
  return Bound{std::max(bytes, arithmetic), bytes >= arithmetic, bytes >= arithmetic && pass.bytes_at_most()};
}

Holder Profile::held_back_by(const ProfiledPass& pass) const {
  if (!pass.left_out.empty()) return {"left out", fmt::format("it is never launched, as {}", pass.left_out)};
  if (pass.host) return {"the processor", "it runs on the processor, and the device waits for it"};
  const double bytes = share_of_copy(pass), arithmetic = share_of_arithmetic(pass).value_or(0);
  if (arithmetic > beyond_bound)
    return {"arithmetic",
            fmt::format("the formulas' additions and multiplications would take {:.1f} times as long at the device's rate: "
                        "the kernel does with fewer",
                        arithmetic)};
  if (arithmetic >= near_bound && (arithmetic > bytes || bytes > beyond_bound || pass.bytes_at_most()))
    return {"arithmetic",
            fmt::format("it adds and multiplies at {} of the rate of which the device is capable", percent(arithmetic))};
  if (bytes >= near_bound && bytes <= beyond_bound && !pass.bytes_at_most())
    return {"bandwidth", fmt::format("it moves bytes at {} of the rate at which the device copies", percent(bytes))};
  if (bytes > beyond_bound && !pass.bytes_at_most())
    return {"caches",
            fmt::format(
                "caches hold what it works on, or it leaves elements out: {:.1f} times the bytes a second that the device copies",
                bytes)};
  if (const double middle = median(pass.seconds); middle <= 2 * speed.launch)
    return {"launching",
            fmt::format("it takes {:.1f} us, where empty kernels take {:.1f} us each", 1e6 * middle, 1e6 * speed.launch)};
  return by_its_own_work(*this, pass);
}

}  // namespace firn::app
