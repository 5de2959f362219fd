// Pictures of results, by gnuplot: lines over what was varied, bars for the rest.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "app/bench.h"
#include "app/statistics.h"
#include "stages/process.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;

// In double quotes, where gnuplot would take "_" and "^" for subscripts but for `noenhanced`.
std::string literal(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' || c == '\\' ? '\'' : c;
  return result + "\"";
}

void draw(const fs::path& program, const fs::path& file, const std::string& script) {
  const fs::path log = file.parent_path() / (file.stem().string() + ".log");
  fs::remove(log);
  stages::Process gnuplot(program, {"-"}, "", log);
  gnuplot.feed(std::as_bytes(std::span(script)));
  if (gnuplot.finish() != 0 || !fs::exists(file))
    throw std::runtime_error(fmt::format("gnuplot could not draw {}; see {}", file.string(), log.string()));
  fs::remove(log);
}

std::string begin_of(const fs::path& file, const std::string& title, int height) {
  return fmt::format(
      "set terminal pngcairo noenhanced size 1000,{} font \"sans,11\" background \"#ffffff\"\nset output {}\nset title {} font "
      "\"sans,14\"\nset border 3 lc rgb \"#5d6c7b\"\nset tics nomirror\nset grid lc rgb \"#e2e7ed\" lt 1\n",
      height, literal(file.string()), literal(title));
}

std::string lines(const fs::path& file, const std::string& title, const std::string& along,
                  const std::vector<const BenchResult*>& results) {
  std::map<std::string, std::vector<const BenchResult*>> series;
  std::vector<std::string> order;
  for (const BenchResult* result : results) {
    if (!series.contains(result->series)) order.push_back(result->series);
    series[result->series].push_back(result);
  }
  std::string script = begin_of(file, title, 600), plots;
  script += fmt::format("set logscale xy\nset format y \"%g\"\nset xlabel {}\nset ylabel \"milliseconds\"\nset key left top\n",
                        literal(along));
  for (std::size_t i = 0; i < order.size(); ++i) {
    script += fmt::format("$d{} << EOD\n", i);
    for (const BenchResult* result : series[order[i]]) script += fmt::format("{} {}\n", result->x, 1e3 * median(result->seconds));
    script += "EOD\n";
    plots += fmt::format("{}$d{} using 1:2 with linespoints lw 2 pt 7 title {}", i == 0 ? "" : ", ", i, literal(order[i]));
  }
  return script + "plot " + plots + "\n";
}

// One above the other, the first on top.
std::string bars(const fs::path& file, const std::string& title, const std::vector<const BenchResult*>& results) {
  const auto count = results.size();
  std::string script = begin_of(file, title, static_cast<int>(110 + 22 * count));
  script += fmt::format(
      "set xlabel \"milliseconds\"\nset xrange [0:*]\nset yrange [-0.6:{}]\nset style fill solid\nunset key\nset grid noytics\n",
      static_cast<double>(count) - 0.4);
  script += "$d << EOD\n";
  for (std::size_t i = 0; i < count; ++i)
    script += fmt::format("{} {} {}\n", count - 1 - i, 1e3 * median(results[i]->seconds),
                          literal(results[i]->name.substr(results[i]->name.find('/') + 1)));
  return script + "EOD\nplot $d using ($2/2):1:($2/2):(0.35):ytic(3) with boxxyerror lc rgb \"#4a7fb0\"\n";
}

}  // namespace

fs::path prepare_plots(const std::string& folder) {
  fs::path program = stages::find_program("gnuplot");
  if (program.empty()) throw std::runtime_error("no plots: gnuplot is not installed (Debian: gnuplot-nox)");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("cannot make the folder {}: {}", folder, error.message()));
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw std::runtime_error(fmt::format("cannot write into the folder {}: {}", folder, std::strerror(errno)));
  return program;
}

void plot_bench(const Bench& bench, const fs::path& gnuplot, const std::string& folder) {
  const std::string device = bench.opened() != nullptr ? bench.opened()->info().name : "no device";
  // By benchmark, and within one by what was varied.
  std::map<std::string, std::map<std::string, std::vector<const BenchResult*>>> groups;
  for (const BenchResult& result : bench.results())
    groups[result.name.substr(0, result.name.find('/'))][result.along].push_back(&result);
  for (const auto& [name, by_along] : groups)
    for (const auto& [along, results] : by_along) {
      std::string stem = name;
      if (!along.empty() && by_along.size() > 1) stem += "_" + along.substr(0, along.find(' '));
      const fs::path file = fs::path(folder) / (stem + ".png");
      const std::string title = fmt::format("{}, {}", name, device);
      draw(gnuplot, file, along.empty() ? bars(file, title, results) : lines(file, title, along, results));
    }
}

}  // namespace firn::app
