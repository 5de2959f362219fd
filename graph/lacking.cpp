#include "graph/lacking.h"

#include <fmt/format.h>

#include <algorithm>

namespace firn::graph {
namespace {

void add(std::vector<std::string>& list, const std::string& word) {
  if (std::ranges::find(list, word) == list.end()) list.push_back(word);
}

// "a, b, c and 7 more".
std::string listed(const std::vector<std::string>& words) {
  constexpr std::size_t most = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, words.size()); ++i) text += (i == 0 ? "" : ", ") + words[i];
  return words.size() > most ? fmt::format("{} and {} more", text, words.size() - most) : text;
}

}  // namespace

void Lacking::note(const std::string& reason, const config::Place& place, const std::string& stage, const std::string& name,
                   const std::string& text) {
  Needs& needs = by_reason_[reason];
  if (needs.stages.empty()) {
    needs.first = place;
    needs.only = text;
  }
  add(needs.stages, stage);
  add(needs.names, fmt::format("'{}'", name));
}

void Lacking::tell(config::Diagnostics& diagnostics) const {
  for (const auto& [reason, needs] : by_reason_) {
    if (needs.stages.size() == 1 && needs.names.size() == 1) {
      diagnostics.error(needs.first, fmt::format("{}: {}", needs.only, reason));
      continue;
    }
    const std::string who = needs.stages.size() == 1
                                ? needs.stages.front() + " needs"
                                : fmt::format("{} stages ({}) need", needs.stages.size(), listed(needs.stages));
    diagnostics.error(needs.first, fmt::format("{} {}, which {} not known here: {}", who, listed(needs.names),
                                               needs.names.size() == 1 ? "is" : "are", reason));
  }
}

}  // namespace firn::graph
