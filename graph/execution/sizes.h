#pragma once

// Domains whose elements come and go while a plan is executed. Memory is there for as many as were planned; counts, bytes, sizes of
// dispatches and reads follow how many there are.

#include <map>
#include <span>
#include <string>

#include "graph/execution/kernels.h"

namespace firn::execution {

class Sizes {
 public:
  // All of them outlive this. Stages in the order of the plan.
  Sizes(graph::Plan& plan, Memory& memory, std::vector<std::vector<Kernel>>& kernels, std::vector<gpu::Buffer>& parameters)
      : plan_(plan), memory_(memory), kernels_(kernels), parameters_(parameters), room_(plan.environment.domains) {}

  // The counts of the domain and of all buffers over it. Throws std::logic_error where there is no room for so many.
  void set(const std::string& domain, std::uint64_t count);

  // Buffers over the domain that are kept between steps go along; others are written anew before they are read.
  void keep(const std::string& domain, std::span<const std::uint32_t> elements);  // ascending
  void append(const std::string& domain, std::uint64_t count);                    // zeros

  void upload_parameters(int stage);

 private:
  [[nodiscard]] std::uint64_t count(const std::string& domain) const { return plan_.environment.domains.at(domain).count; }
  [[nodiscard]] std::vector<int> kept_buffers(const std::string& domain) const;

  graph::Plan& plan_;
  Memory& memory_;
  std::vector<std::vector<Kernel>>& kernels_;
  std::vector<gpu::Buffer>& parameters_;
  const std::map<std::string, graph::DomainSize> room_;
};

}  // namespace firn::execution
