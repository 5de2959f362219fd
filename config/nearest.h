#pragma once

// Help for mistyped names.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace firn::config {

// The choice with the smallest edit distance (insert, delete, replace, swap of neighbours), if it is near enough to be meant.
// Of more than 256 choices the first ones are looked at.
std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& choices);

// Tail of an error text: "; did you mean 'x'?" where one is near, else "; valid: a, b, c" (at most 12 names, then how many more).
std::string suggestion(std::string_view word, const std::vector<std::string>& choices);

}  // namespace firn::config
