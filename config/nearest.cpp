#include "config/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace firn::config {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Edit distance with swaps of neighbours, each part edited at most once ("optimal string alignment"); upper and lower case are
// alike.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1])) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

// Which characters a text has. One edit adds at most one of them and takes away at most one.
std::uint64_t letters(std::string_view text) {
  std::uint64_t set = 0;
  for (const char c : text) set |= std::uint64_t{1} << (static_cast<unsigned char>(lower(c)) % 64);
  return set;
}

// So that thousands of mistakes among thousands of names are told in a moment.
constexpr std::size_t most_compared = 256;

// A third of the letters may differ, one in short words, but never all of them.
std::size_t largest_distance(std::size_t length) { return length < 2 ? 0 : std::max<std::size_t>(1, length / 3); }

}  // namespace

std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& choices) {
  std::optional<std::string> best;
  std::size_t best_distance = 0;
  const std::uint64_t of_word = letters(word);
  for (const std::string& choice : std::span(choices).first(std::min(choices.size(), most_compared))) {
    const std::size_t longer = std::max(word.size(), choice.size());
    const std::size_t shorter = std::min(word.size(), choice.size());
    const std::size_t limit = largest_distance(longer);
    if (longer - shorter > limit || std::popcount(of_word ^ letters(choice)) > static_cast<int>(2 * limit)) continue;
    const std::size_t found = distance(word, choice);
    if (found > limit || (best && found >= best_distance)) continue;
    best = choice;
    best_distance = found;
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& choices) {
  if (const auto near = nearest(word, choices)) return fmt::format("; did you mean '{}'?", *near);
  if (choices.empty()) return "";
  constexpr std::size_t most = 12;
  const std::size_t shown = std::min(choices.size(), most);
  std::string text =
      fmt::format("; valid: {}", fmt::join(choices.begin(), choices.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (choices.size() > shown) text += fmt::format(" and {} more", choices.size() - shown);
  return text;
}

}  // namespace firn::config
