#pragma once

// The standard measurements. What is compared is run in turn within one call, and medians are told: machines are noisy.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/load.h"
#include "graph/execution/execution.h"

namespace firn::app {

struct BenchResult {
  std::string name;                     // "step/mpm_snow/50000"
  std::vector<double> seconds;          // one per run
  double count = 1;                     // what the rate counts: particles, steps, stages
  std::string unit = "steps/s";         // of the rate
  std::string series = {}, along = {};  // for plots: the line it lies on, and what `x` is; without, it is a bar
  double x = 0;
  std::string remark = {};  // for people

  [[nodiscard]] double rate() const;
};
struct NotPossible {
  std::string name, reason;
};

// One call of the verb: what is wanted, and what came of it.
class Bench {
 public:
  struct Wanted {
    std::string only;  // names that begin with this, or lead to it; empty: all
    bool small = false;
    int runs = 7;
    std::string device = "auto";
    bool quiet = false;    // nothing is printed as it comes
    bool listing = false;  // nothing is wanted: only asked() counts
  };
  explicit Bench(Wanted wanted) : wanted_(std::move(wanted)) {}

  [[nodiscard]] bool small() const { return wanted_.small; }
  [[nodiscard]] int runs() const { return wanted_.runs; }
  // Also of names that results begin with.
  [[nodiscard]] bool wants(const std::string& name);
  // Whether names below this one are to be listed: they take reading a pipeline.
  [[nodiscard]] bool lists_below(const std::string& name) const { return wanted_.listing && wanted_.only.starts_with(name + "/"); }
  [[nodiscard]] gpu::Device& device();  // opened when first asked for
  [[nodiscard]] const gpu::Device* opened() const { return device_.get(); }

  void begin(const std::string& name, const std::string& doc);
  void add(BenchResult result);
  void not_possible(const std::string& name, const std::string& reason);

  [[nodiscard]] const std::vector<BenchResult>& results() const { return results_; }
  [[nodiscard]] const std::vector<NotPossible>& impossible() const { return impossible_; }
  [[nodiscard]] const std::vector<std::string>& asked() const { return asked_; }  // when listing: every name that wants() heard of

 private:
  Wanted wanted_;
  std::unique_ptr<gpu::Device> device_;
  std::vector<BenchResult> results_;
  std::vector<NotPossible> impossible_;
  std::vector<std::string> asked_;
};

// Steps of a pipeline on a scene. Files as find_input() finds them, in pipelines/ and bench/.
struct BenchCase {
  std::string name;
  std::string pipeline, scene;
  std::vector<std::string> set;
  bool barriers_all = false;
  bool per_particle = false;  // the rate counts particles times steps, else steps
  std::string series = {}, along = {};
  double x = 0;
};
struct BenchPace {
  int warm_up = 3, steps = 1;  // of one run, and as many more as it takes to fill `seconds`
  double seconds = 0;
};

// A case that runs. Throws what load() and Execution do.
struct BenchRun {
  Loaded loaded;
  std::unique_ptr<execution::Execution> execution;
  gpu::Device* device = nullptr;

  BenchRun(const std::string& pipeline, const std::string& scene, const std::vector<std::string>& set, gpu::Device& device,
           bool barriers_all = false, const std::function<void(Loaded&)>& change = {});
  double steps(int count);  // s of one, everything waited for
};
// The reason in words where `start` finds that this machine cannot do it.
std::optional<std::string> why_not(const std::function<void()>& start);

// Those that are wanted, run after run in turn. With `stages` also what each stage takes, in runs of their own.
void run_in_turn(Bench& bench, const std::vector<BenchCase>& cases, const BenchPace& pace, bool stages = false);

void bench_transfers(Bench& bench);
void bench_step(Bench& bench);
void bench_two_snowballs(Bench& bench);
void bench_heightfield(Bench& bench);
void bench_barriers(Bench& bench);
void bench_graph(Bench& bench);

// gnuplot, and the folder for its pictures made. Throws std::runtime_error where it is not installed, or the folder cannot be had.
std::filesystem::path prepare_plots(const std::string& folder);
// One picture per benchmark, named after it. Throws std::runtime_error where a file cannot be written.
void plot_bench(const Bench& bench, const std::filesystem::path& gnuplot, const std::string& folder);

}  // namespace firn::app
