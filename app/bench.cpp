#include "app/bench.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/choice.h"
#include "app/statistics.h"
#include "app/verbs.h"
#include "config/nearest.h"

namespace firn::app {
namespace {

struct Benchmark {
  const char *name, *doc;
  void (*run)(Bench&);
  bool on_device = true;
};
constexpr Benchmark benchmarks[] = {
    {"transfers", "particles to grid and back, each form by itself, particles in memory by cells or at random", bench_transfers},
    {"step", "a step of material-point snow, falling ball", bench_step},
    {"two_snowballs", "a step of the two snowballs of [M 5.2]", bench_two_snowballs},
    {"heightfield", "a step of the height field, drawing not counted: method, cells along each axis, bodies", bench_heightfield},
    {"barriers", "the plan's own barriers against a full one after every piece of work", bench_barriers},
    {"graph", "planning a pipeline of so many stages", bench_graph, false},
};

// Every name that there is with these sizes, and what those begin with; short ones first. Opens no device.
std::vector<std::string> names(const std::string& wanted, bool small) {
  Bench bench({.only = wanted, .small = small, .listing = true});
  for (const Benchmark& one : benchmarks) one.run(bench);
  std::vector<std::string> all;
  for (const std::string& name : bench.asked())
    for (std::size_t end = 0; end != std::string::npos;) {
      end = name.find('/', end + 1);
      if (const std::string part = name.substr(0, end); std::ranges::find(all, part) == all.end()) all.push_back(part);
    }
  std::ranges::stable_sort(all, {}, [](const std::string& name) { return std::ranges::count(name, '/'); });
  return all;
}

// What is wrong with the name of what is wanted; empty: nothing.
std::string problem_of(const Bench::Wanted& wanted) {
  const auto has = [&](const std::vector<std::string>& all) { return std::ranges::find(all, wanted.only) != all.end(); };
  const std::vector<std::string> there = names(wanted.only, wanted.small);
  if (wanted.only.empty() || has(there)) return "";
  const char *these = wanted.small ? "small" : "full", *others = wanted.small ? "full" : "small";
  if (has(names(wanted.only, !wanted.small)))
    return fmt::format("no benchmark '{}' with --sizes {}: it is one of --sizes {}", wanted.only, these, others);
  return fmt::format("no benchmark '{}'{}", wanted.only, config::suggestion(wanted.only, there));
}

// Whether `name` lies on the path `below` or is it.
bool leads_to(const std::string& name, const std::string& below) { return below == name || below.starts_with(name + "/"); }

struct BenchOptions {
  Bench::Wanted wanted;
  std::string sizes = "full", plots;
  std::optional<int> runs;
  bool json = false;
};

nlohmann::json as_json(const Bench& bench) {
  nlohmann::json results = nlohmann::json::array(), impossible = nlohmann::json::array();
  for (const BenchResult& result : bench.results())
    results.push_back({{"name", result.name},
                       {"seconds", median(result.seconds)},
                       {"runs", result.seconds.size()},
                       {"rate", result.rate()},
                       {"unit", result.unit}});
  for (const NotPossible& one : bench.impossible()) impossible.push_back({{"name", one.name}, {"reason", one.reason}});
  nlohmann::json all = {{"device", bench.opened() != nullptr ? bench.opened()->info().name : "none"}, {"results", results}};
  if (!impossible.empty()) all["not_possible"] = impossible;
  return all;
}

int bench(BenchOptions options) {
  options.wanted.small = options.sizes == "small";
  options.wanted.runs = options.runs.value_or(options.wanted.small ? 5 : 7);
  options.wanted.quiet = options.json;
  if (const std::string problem = problem_of(options.wanted); !problem.empty()) {
    fmt::print(stderr, "firn bench: {}\nfirn bench --help tells what there is\n", problem);
    return Status::bad_input;
  }
  const std::filesystem::path gnuplot = options.plots.empty() ? "" : prepare_plots(options.plots);
  Bench bench(options.wanted);
  for (const Benchmark& one : benchmarks) {
    if (!bench.wants(one.name)) continue;
    if (one.on_device) static_cast<void>(bench.device());
    bench.begin(one.name, one.doc);
    one.run(bench);
  }
  if (options.json) fmt::print("{}\n", as_json(bench).dump(2));
  if (!options.plots.empty()) plot_bench(bench, gnuplot, options.plots);
  return Status::done;
}

}  // namespace

double BenchResult::rate() const {
  const double middle = median(seconds);
  return middle > 0 ? count / middle : 0;
}

bool Bench::wants(const std::string& name) {
  if (wanted_.listing) {
    asked_.push_back(name);
    return false;
  }
  return wanted_.only.empty() || leads_to(wanted_.only, name) || leads_to(name, wanted_.only);
}

gpu::Device& Bench::device() {
  if (device_) return *device_;
  device_ = gpu::Device::open(wanted_.device);
  if (!wanted_.quiet) fmt::print("{}\n", device_->info().name);
  return *device_;
}

void Bench::begin(const std::string& name, const std::string& doc) {
  if (!wanted_.quiet) fmt::print("\n{}: {}; medians of {} runs, in turn\n", name, doc, wanted_.runs);
}

void Bench::add(BenchResult result) {
  if (!wanted_.quiet) {
    const double seconds = median(result.seconds);
    fmt::print("{:<56} {:>12.4f} ms  {:>11.4g} {}{}\n", result.name, 1e3 * seconds, result.rate(), result.unit,
               result.remark.empty() ? "" : "  " + result.remark);
    std::fflush(stdout);
  }
  results_.push_back(std::move(result));
}

void Bench::not_possible(const std::string& name, const std::string& reason) {
  if (!wanted_.quiet) fmt::print("{:<56} not possible here: {}\n", name, reason);
  impossible_.push_back({name, reason});
}

void add_bench(CLI::App& program, Action& action) {
  const auto options = std::make_shared<BenchOptions>();
  std::string names;
  for (const Benchmark& one : benchmarks) names += (names.empty() ? "" : ", ") + std::string(one.name);
  CLI::App* verb = program.add_subcommand("bench", "The standard measurements: " + names);
  verb->add_option("NAME", options->wanted.only, "One of them, or one measurement, such as step/mpm_snow/box (default: all)");
  verb->add_option("--sizes", options->sizes, "small: for machines without a GPU; full")
      ->check(one_of({"small", "full"}))
      ->capture_default_str();
  verb->add_option("--runs", options->runs, "Runs whose median is told (default: 7, of small sizes 5)")->check(CLI::Range(1, 1000));
  verb->add_option("--device", options->wanted.device, "As for run")->capture_default_str();
  verb->add_option("--plots", options->plots, "Folder for one picture (PNG) per benchmark; they take gnuplot");
  verb->add_flag("--json", options->json, "As JSON");
  verb->callback([&action, options] { action = [options] { return bench(*options); }; });
}

}  // namespace firn::app
