#include "graph/environment.h"

#include <charconv>

namespace firn::graph {
namespace {

constexpr std::uint64_t largest_count = std::uint64_t{1} << 53;

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

const Constant* Environment::constant(const std::string& name) const {
  for (const Constant& constant : constants)
    if (constant.name == name) return &constant;
  return nullptr;
}

std::optional<std::uint64_t> element_count(const std::string& domain, const Environment& environment) {
  const auto sign = domain.find_first_of("*/");
  const std::string base = domain.substr(0, sign);
  std::optional<std::uint64_t> count = whole_number(base);
  if (!count) {
    const auto found = environment.domains.find(base);
    if (found == environment.domains.end()) return std::nullopt;
    count = found->second.count;
  }
  if (sign == std::string::npos) return *count <= largest_count ? count : std::nullopt;
  const auto factor = whole_number(std::string_view(domain).substr(sign + 1));
  if (!factor || *factor == 0) return std::nullopt;
  if (domain[sign] == '/') return (*count + *factor - 1) / *factor;
  if (*count > largest_count / *factor) return std::nullopt;
  return *count * *factor;
}

std::string base_domain(const std::string& domain) {
  std::string base = domain.substr(0, domain.find_first_of("*/"));
  return whole_number(base) ? std::string{} : base;
}

}  // namespace firn::graph
