#include "graph/execution/sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace firn::execution {

using graph::PlannedBuffer;

void Sizes::set(const std::string& domain, std::uint64_t count) {
  if (const auto room = room_.find(domain); room == room_.end() || count > room->second.count)
    throw std::logic_error(fmt::format("no room for {} elements of '{}'", count, domain));
  plan_.environment.domains.at(domain).count = count;
  for (PlannedBuffer& buffer : plan_.buffers)
    if (graph::base_domain(buffer.domain) == domain && !buffer.texture) {
      buffer.count = graph::element_count(buffer.domain, plan_.environment).value_or(0);
      buffer.bytes = buffer.count * graph::stride(buffer.type);
    }
  for (std::size_t s = 0; s < plan_.stages.size(); ++s) {
    const std::vector<graph::Port>& ports = plan_.stages[s].spec.ports;
    if (std::ranges::any_of(ports, [&](const graph::Port& port) { return graph::base_domain(port.domain) == domain; }))
      upload_parameters(static_cast<int>(s));
    for (std::size_t w = 0; w < kernels_[s].size(); ++w)
      size_kernel(kernels_[s][w], plan_, static_cast<int>(s), static_cast<int>(w));
  }
}

void Sizes::upload_parameters(int stage) {
  const std::vector<std::byte> block = graph::parameter_block(plan_, stage);
  if (!block.empty()) parameters_[static_cast<std::size_t>(stage)].upload(0, block);
}

// What is scaled down ("particles/256") holds nothing of any single element.
std::vector<int> Sizes::kept_buffers(const std::string& domain) const {
  std::vector<int> buffers;
  for (int b = 0; b < static_cast<int>(plan_.buffers.size()); ++b)
    if (const PlannedBuffer& buffer = plan_.buffers[static_cast<std::size_t>(b)];
        graph::base_domain(buffer.domain) == domain && buffer.domain.find('/') == std::string::npos && !buffer.texture &&
        buffer.lifetime == graph::Lifetime::state)
      buffers.push_back(b);
  return buffers;
}

void Sizes::keep(const std::string& domain, std::span<const std::uint32_t> elements) {
  std::size_t first = 0;  // that moves
  while (first < elements.size() && elements[first] == first) ++first;
  if (first < elements.size()) {
    gpu::memory_barrier(graph::bit_buffer_update);
    for (const int b : kept_buffers(domain)) {
      const std::uint64_t bytes = plan_.buffers[static_cast<std::size_t>(b)].bytes / count(domain);
      std::vector<std::byte> before(bytes * (count(domain) - first)), after;
      memory_.buffer(b).download(bytes * first, before);
      after.reserve(bytes * (elements.size() - first));
      for (const std::uint32_t element : elements.subspan(first)) {
        const auto from = before.begin() + static_cast<std::ptrdiff_t>(bytes * (element - first));
        after.insert(after.end(), from, from + static_cast<std::ptrdiff_t>(bytes));
      }
      memory_.buffer(b).upload(bytes * first, after);
    }
  }
  set(domain, elements.size());
}

void Sizes::append(const std::string& domain, std::uint64_t more) {
  std::vector<std::pair<int, std::uint64_t>> ends;
  for (const int b : kept_buffers(domain)) ends.emplace_back(b, plan_.buffers[static_cast<std::size_t>(b)].bytes);
  set(domain, count(domain) + more);
  gpu::memory_barrier(graph::bit_buffer_update);
  for (const auto& [b, end] : ends)
    if (const std::uint64_t bytes = plan_.buffers[static_cast<std::size_t>(b)].bytes - end; bytes > 0)
      memory_.buffer(b).upload(end, std::vector<std::byte>(bytes));
}

}  // namespace firn::execution
