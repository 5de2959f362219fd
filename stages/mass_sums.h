#pragma once

// Sums of particles' masses in a buffer: two floats each, the second what the first is short of, so that no particle is lost in a
// large sum. Their doubles are exact for particles of equal mass.

#include "graph/host.h"
#include "graph/spec.h"

namespace firn::stages {

inline graph::Port mass_sums(std::string name, std::string domain, std::string doc) {
  return {.name = std::move(name),
          .type = graph::ElementType::vec2,
          .domain = std::move(domain),
          .access = graph::Access::read_write,
          .usage = graph::Usage::host,
          .unit = "kg",
          .doc = std::move(doc) + "; the two numbers make one sum"};
}

inline std::vector<double> read_mass_sums(graph::HostContext& context, std::string_view port) {
  const std::vector<float> pairs = context.read_floats(port);
  std::vector<double> sums;
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
    sums.push_back(static_cast<double>(pairs[i]) + static_cast<double>(pairs[i + 1]));
  return sums;
}

inline void write_mass_sums(graph::HostContext& context, std::string_view port, const std::vector<double>& sums) {
  std::vector<float> pairs;
  for (const double sum : sums) {
    pairs.push_back(static_cast<float>(sum));
    pairs.push_back(static_cast<float>(sum - static_cast<double>(pairs.back())));
  }
  context.write_floats(port, pairs);
}

}  // namespace firn::stages
