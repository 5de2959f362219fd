#include "app/compare_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "app/statistics.h"

namespace firn::app {
namespace {

// The label without the number that later uses of a stage have: which number it is depends on the pipeline's other phases.
std::string unnumbered(const std::string& label) { return label.substr(0, label.find('#')); }

std::vector<PassPair> paired(const Side& a, const Side& b) {
  std::vector<PassPair> pairs;
  // Of several uses in one phase, the first goes with the first.
  const auto find = [&](const PassTimes& pass) -> PassPair* {
    for (PassPair& pair : pairs)
      if (pair.phase == pass.phase && unnumbered(pair.stage) == unnumbered(pass.stage) && pair.work == pass.work &&
          pair.b.launches == 0)
        return &pair;
    return nullptr;
  };
  for (const PassTimes& pass : a.passes)
    pairs.push_back({pass.phase, pass.stage, pass.work, {pass.seconds.size(), median(pass.seconds), pass.total()}, {}});
  // Those that B alone has stand behind what comes before them in B.
  std::size_t place = 0;
  for (const PassTimes& pass : b.passes) {
    PassPair* pair = find(pass);
    if (pair == nullptr)
      pair = &*pairs.insert(pairs.begin() + static_cast<std::ptrdiff_t>(place), {pass.phase, pass.stage, pass.work, {}, {}});
    place = static_cast<std::size_t>(pair - pairs.data()) + 1;
    pair->b = {pass.seconds.size(), median(pass.seconds), pass.total()};
  }
  return pairs;
}

Difference difference(const std::string& name, const Contents& a, const Contents& b) {
  Difference result{name, a.domain, a.unit};
  const auto parts = static_cast<std::size_t>(graph::components(a.type));
  result.elements = a.scalars() / parts;
  double sum = 0;
  for (std::size_t i = 0; i < result.elements; ++i) {
    double apart = 0, length = 0;
    for (std::size_t c = 0; c < parts; ++c) {
      const double one = a.value(i * parts + c), other = b.value(i * parts + c);
      apart += one == other ? 0 : (one - other) * (one - other);  // the same infinity is no difference
      length += one * one;
    }
    if (std::isfinite(length)) result.largest = std::max(result.largest, std::sqrt(length));
    if (!std::isfinite(apart)) {
      ++result.not_finite;
      continue;
    }
    result.max = std::max(result.max, std::sqrt(apart));
    sum += apart;
  }
  const std::size_t counted = result.elements - result.not_finite;
  result.rms = counted > 0 ? std::sqrt(sum / static_cast<double>(counted)) : 0;
  return result;
}

void compare_pictures(Comparison& comparison) {
  const auto &a = comparison.a.picture, &b = comparison.b.picture;
  if (!a || !b || a->width != b->width || a->height != b->height) return;
  stages::Picture result = *a;
  std::array<std::size_t, 256> counts{};
  double sum = 0;
  for (std::size_t i = 0; i < result.rgb.size(); ++i) {
    const int apart = std::abs(int{a->rgb[i]} - int{b->rgb[i]});
    ++counts[static_cast<std::size_t>(apart)];
    sum += double(apart) * apart;
    result.rgb[i] = static_cast<std::uint8_t>(apart);
  }
  comparison.picture_rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, result.rgb.size())));
  // All but one in a thousand values stay below white.
  std::size_t bright = 255;
  for (std::size_t beyond = counts[255]; bright > 1 && beyond <= result.rgb.size() / 1000; beyond += counts[bright]) --bright;
  comparison.picture_gain = 255.0 / static_cast<double>(bright);
  for (std::uint8_t& value : result.rgb) value = static_cast<std::uint8_t>(std::min(255.0, value * comparison.picture_gain));
  comparison.difference = std::move(result);
}

std::string per_launch(double seconds, std::uint64_t launches) {
  return launches == 0 ? "-" : fmt::format("{:.1f}", 1e6 * seconds);
}

std::string ratio(double a, double b) { return a > 0 && b > 0 ? fmt::format("{:.2f}", b / a) : "-"; }

}  // namespace

Comparison compare_sides(std::string scene, std::string device, Side a, Side b) {
  Comparison result;
  result.scene = std::move(scene);
  result.device = std::move(device);
  result.passes = paired(a, b);
  for (const auto& [name, contents] : a.buffers) {
    const auto other = b.buffers.find(name);
    if (other != b.buffers.end() && other->second.type == contents.type && other->second.packed.size() == contents.packed.size())
      result.differences.push_back(difference(name, contents, other->second));
    else
      result.only_a.push_back(name);
  }
  for (const auto& [name, contents] : b.buffers)
    if (std::ranges::find(result.differences, name, &Difference::buffer) == result.differences.end()) result.only_b.push_back(name);
  result.a = std::move(a);
  result.b = std::move(b);
  compare_pictures(result);
  return result;
}

std::string as_table(const Comparison& comparison) {
  const Side &a = comparison.a, &b = comparison.b;
  std::string text = fmt::format("{}\n{}\non {}, {}: {} and {} steps, {:.4g} and {:.4g} s simulated\n\n", a.title(), b.title(),
                                 comparison.scene, comparison.device, a.steps, b.steps, a.simulated, b.simulated);
  text += fmt::format("{:<6} {:<34} {:<38} {:>11} {:>11} {:>7}\n", "phase", "stage", "work", "A: us", "B: us", "B / A");
  for (const PassPair& pass : comparison.passes)
    text += fmt::format("{:<6} {:<34} {:<38} {:>11} {:>11} {:>7}\n", pass.phase, pass.stage, pass.work,
                        per_launch(pass.a.median, pass.a.launches), per_launch(pass.b.median, pass.b.launches),
                        ratio(pass.a.median, pass.b.median));
  text += fmt::format("{:<80} {:>11.3f} {:>11.3f} {:>7}\n\n", "a step in all its passes, ms", a.milliseconds_per_step(),
                      b.milliseconds_per_step(), ratio(a.milliseconds_per_step(), b.milliseconds_per_step()));
  text += fmt::format("{:<26} {:<12} {:<12} {:>10} {:>12} {:>12} {:>12}\n", "buffer", "domain", "unit", "elements", "max |A-B|",
                      "rms", "max |A|");
  for (const Difference& d : comparison.differences)
    text += fmt::format("{:<26} {:<12} {:<12} {:>10} {:>12.4g} {:>12.4g} {:>12.4g}{}\n", d.buffer, d.domain, d.unit, d.elements,
                        d.max, d.rms, d.largest, d.not_finite > 0 ? fmt::format("  {} not finite", d.not_finite) : "");
  if (!comparison.only_a.empty()) text += fmt::format("only A has {}\n", fmt::join(comparison.only_a, ", "));
  if (!comparison.only_b.empty()) text += fmt::format("only B has {}\n", fmt::join(comparison.only_b, ", "));
  for (const Mass& mass : a.masses) {
    const auto other = std::ranges::find(b.masses, mass.of, &Mass::of);
    if (other == b.masses.end()) continue;
    text += fmt::format("mass of {}: {:.6f} and {:.6f} kg", mass.of, mass.kilograms, other->kilograms);
    text += fmt::format(", {:+.3g} kg\n", other->kilograms - mass.kilograms);
  }
  if (comparison.difference) text += fmt::format("pictures: rms {:.3f} of 255\n", comparison.picture_rms);
  return text;
}

nlohmann::json as_json(const Comparison& comparison) {
  using nlohmann::json;
  const auto side = [](const Side& s) {
    json masses = json::object();
    for (const Mass& mass : s.masses) masses[mass.of] = mass.kilograms;
    return json{{"pipeline", s.pipeline},           {"set", s.changes},     {"steps", s.steps},
                {"simulated_seconds", s.simulated}, {"seconds", s.seconds}, {"milliseconds_per_step", s.milliseconds_per_step()},
                {"device_bytes", s.device_bytes},   {"masses", masses}};
  };
  json passes = json::array(), differences = json::array();
  const auto times = [](const auto& t) { return json{{"launches", t.launches}, {"median", t.median}, {"total", t.total}}; };
  for (const PassPair& pass : comparison.passes)
    passes.push_back(
        {{"phase", pass.phase}, {"stage", pass.stage}, {"work", pass.work}, {"a", times(pass.a)}, {"b", times(pass.b)}});
  for (const Difference& d : comparison.differences)
    differences.push_back({{"buffer", d.buffer},
                           {"domain", d.domain},
                           {"unit", d.unit},
                           {"elements", d.elements},
                           {"not_finite", d.not_finite},
                           {"max", d.max},
                           {"rms", d.rms},
                           {"largest", d.largest}});
  json result = {
      {"scene", comparison.scene}, {"device", comparison.device}, {"a", side(comparison.a)},     {"b", side(comparison.b)},
      {"passes", passes},          {"differences", differences},  {"only_a", comparison.only_a}, {"only_b", comparison.only_b},
      {"pictures", nullptr}};
  if (comparison.difference) result["pictures"] = {{"rms", comparison.picture_rms}, {"gain", comparison.picture_gain}};
  return result;
}

}  // namespace firn::app
