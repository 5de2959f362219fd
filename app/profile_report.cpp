#include <fmt/format.h>

#include "app/profile.h"
#include "app/statistics.h"

namespace firn::app {
namespace {

using nlohmann::json;

// "<= 12.3 % bytes"
std::string in_words(const Profile::Bound& bound) {
  return fmt::format("{}{:.1f} % {}", bound.at_most ? "<= " : "", 100 * bound.share, bound.by_bytes ? "bytes" : "maths");
}

}  // namespace

std::string as_table(const Profile& profile) {
  std::string text = fmt::format("{} on {}, {}\n\n", profile.pipeline, profile.scene, profile.device);
  std::size_t longest = 0;
  for (const ProfiledPass& pass : profile.passes) longest = std::max(longest, pass.stage.size());
  text += fmt::format("{:<{}} {:<36} {:>8} {:>10} {:>10} {:>7} {:>9} {:>8} {:>17}  {}\n", "stage", longest, "work", "per step",
                      "median us", "p90 us", "share", "MB", "GB/s", "of nearer bound", "held back by");
  std::string sentences;
  for (const ProfiledPass& pass : profile.passes) {
    const double launches = static_cast<double>(pass.seconds.size()) / static_cast<double>(profile.steps);
    const std::optional<Profile::Bound> bound = profile.bound(pass);
    const std::string bytes = bound ? fmt::format("{:>9.3f} {:>8.2f}", 1e-6 * pass.bytes(), 1e-9 * pass.bytes_per_second())
                                    : fmt::format("{:>9} {:>8}", "-", "-");
    const Holder holder = profile.held_back_by(pass);
    text += fmt::format("{:<{}} {:<36} {:>8.2f} {:>10.1f} {:>10.1f} {:>6.1f}% {} {:>17}  {}\n", pass.stage, longest, pass.work,
                        launches, 1e6 * median(pass.seconds), 1e6 * quantile(pass.seconds, 0.9), 100 * profile.share_of_time(pass),
                        bytes, bound ? in_words(*bound) : "-", holder.name);
    sentences += fmt::format("{} {}: {}\n", pass.stage, pass.work, holder.sentence);
  }
  const double steps = static_cast<double>(profile.steps);
  text += fmt::format("\n{} steps: {:.3f} ms a step in passes, {:.3f} ms by the clock on the wall\n", profile.steps,
                      1e3 * profile.total() / steps, 1e3 * profile.wall);
  if (profile.cost)
    text +=
        fmt::format("timing makes a step {:.1f} % longer (median of {} pairs of blocks in turn; half of them {:.1f} to {:.1f} %)\n",
                    100 * profile.cost->median, profile.cost->pairs, 100 * profile.cost->low, 100 * profile.cost->high);
  text += fmt::format("times by {}\n\nWhat holds each back\n{}\n", profile.clock, sentences);
  text += fmt::format(
      "MB: every element that a launch works on read or written once, however often it comes back to it\n"
      "of nearer bound: the time that these bytes would take at the device's rate of copying, or the formulas' additions and\n"
      "  multiplications (maths) at its rate of arithmetic, whichever is longer, by the median; beyond 100 % caches help, or\n"
      "  the kernel does with fewer operations than the formulas;\n"
      "  <=: which elements of some buffers are touched only the kernel knows\n"
      "the device copies {}, multiplies and adds {}, and needs {:.2f} us from launch to launch\n",
      in_words(profile.speed.bandwidth(), "B"), in_words(profile.speed.multiply_add, "FLOP"), 1e6 * profile.speed.launch);
  return text;
}

json as_json(const Profile& profile) {
  json passes = json::array();
  for (const ProfiledPass& pass : profile.passes) {
    json buffers = json::array();
    double read = 0, written = 0;
    for (const Traffic& one : pass.traffic) {
      buffers.push_back({{"buffer", one.buffer},
                         {"access", one.access},
                         {"usage", one.usage},
                         {"read", one.read},
                         {"written", one.written},
                         {"at_most", one.at_most}});
      read += one.read;
      written += one.written;
    }
    const Holder holder = profile.held_back_by(pass);
    json entry = {{"stage", pass.stage},
                  {"work", pass.work},
                  {"elements", pass.elements},
                  {"launches", pass.seconds.size()},
                  {"median", median(pass.seconds)},
                  {"p90", quantile(pass.seconds, 0.9)},
                  {"total", pass.total()},
                  {"share", profile.share_of_time(pass)},
                  {"held_back_by", holder.name},
                  {"reason", holder.sentence}};
    if (!pass.left_out.empty()) entry["left_out"] = pass.left_out;
    if (pass.groups) entry["groups"] = *pass.groups;
    if (const std::optional<Profile::Bound> bound = profile.bound(pass))
      entry.update({{"bytes_read", read},
                    {"bytes_written", written},
                    {"bytes_per_second", pass.bytes_per_second()},
                    {"share_of_copy", profile.share_of_copy(pass)},
                    {"share_of_bound", bound->share},
                    {"bound", bound->by_bytes ? "bytes" : "arithmetic"},
                    {"bytes_at_most", pass.bytes_at_most()},
                    {"buffers", buffers}});
    if (pass.operations)
      entry.update({{"operations", *pass.operations},
                    {"operations_per_second", pass.operations_per_second().value_or(0)},
                    {"share_of_arithmetic", profile.share_of_arithmetic(pass).value_or(0)}});
    passes.push_back(entry);
  }
  json result = {{"pipeline", profile.pipeline},    {"scene", profile.scene}, {"device", profile.device},
                 {"clock", profile.clock},          {"steps", profile.steps}, {"seconds_per_step", profile.wall},
                 {"speed", as_json(profile.speed)}, {"passes", passes}};
  if (profile.cost) result.update({{"cost", profile.cost->median}, {"cost_quartiles", {profile.cost->low, profile.cost->high}}});
  return result;
}

// One row for steps, one for their passes; times in microseconds, as the format has them.
json as_trace(const Profile& profile) {
  const int process = 1, steps_row = 1, passes_row = 2;
  const auto named = [&](const char* what, int row, const std::string& name) {
    return json{{"ph", "M"}, {"name", what}, {"pid", process}, {"tid", row}, {"args", {{"name", name}}}};
  };
  json events = {named("process_name", steps_row, fmt::format("{} on {}", profile.pipeline, profile.device)),
                 named("thread_name", steps_row, "steps"), named("thread_name", passes_row, "passes")};
  const auto bar = [&](const std::string& name, const char* category, int row, double start, double seconds) {
    return json{{"ph", "X"},  {"name", name},      {"cat", category},     {"pid", process},
                {"tid", row}, {"ts", 1e6 * start}, {"dur", 1e6 * seconds}};
  };
  struct Span {
    double begin = 0, end = 0;
  };
  std::vector<Span> steps;
  for (const ProfiledLaunch& launch : profile.launches) {
    const ProfiledPass& pass = profile.passes[launch.pass];
    json event = bar(pass.stage, pass.host ? "host" : "device", passes_row, launch.start, launch.seconds);
    event["args"] = {{"work", pass.work}, {"step", launch.step}};
    if (!pass.host) event["args"]["bytes"] = pass.bytes();
    events.push_back(event);
    if (launch.step >= steps.size()) steps.resize(launch.step + 1, {launch.start, launch.start + launch.seconds});
    Span& step = steps[launch.step];
    step = {std::min(step.begin, launch.start), std::max(step.end, launch.start + launch.seconds)};
  }
  for (std::size_t i = 0; i < steps.size(); ++i)
    events.push_back(bar(fmt::format("step {}", i), "step", steps_row, steps[i].begin, steps[i].end - steps[i].begin));
  return {{"displayTimeUnit", "ms"},
          {"traceEvents", events},
          {"otherData",
           {{"pipeline", profile.pipeline}, {"scene", profile.scene}, {"device", profile.device}, {"clock", profile.clock}}}};
}

}  // namespace firn::app
