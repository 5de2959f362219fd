#pragma once

// What two sides differ in, as numbers, as a table, and as a page.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/compare_run.h"

namespace firn::app {

// One pass beside the other's of the same stage and work; a side without it has 0 launches.
struct PassPair {
  std::string phase, stage, work;
  struct {
    std::uint64_t launches = 0;
    double median = 0, total = 0;  // s
  } a, b;
};

// One buffer that both have. Of vectors and matrices, the length of the difference of each element counts.
struct Difference {
  std::string buffer, domain, unit;
  std::size_t elements = 0, not_finite = 0;  // elements that are not finite in either are left out of the rest
  double max = 0, rms = 0, largest = 0;      // largest: length of any element of A
};

struct Comparison {
  std::string scene, device;
  Side a, b;
  std::vector<PassPair> passes;
  std::vector<Difference> differences;
  std::vector<std::string> only_a, only_b;    // buffers, and those of another shape
  std::optional<stages::Picture> difference;  // of the pictures, channel by channel
  double picture_gain = 1;                    // what it was multiplied by to be seen
  double picture_rms = 0;                     // before that, of 255
};

Comparison compare_sides(std::string scene, std::string device, Side a, Side b);

std::string as_table(const Comparison& comparison);
nlohmann::json as_json(const Comparison& comparison);

// Writes index.html, comparison.json and the pictures into a folder, which is made.
void write_report(const Comparison& comparison, const std::string& folder);

}  // namespace firn::app
