#pragma once

// Numbers as YAML 1.2 writes them (core schema), whatever the locale.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace firn::config {

// Decimal, 1e-4, .5, 0x10, 0o17. Nothing for other texts and what a double cannot hold.
std::optional<double> parse_number(std::string_view text);

// Whole numbers in any of these forms, 8.0 and 1e3 too. Nothing where it does not fit in 64 bits. Digits alone are
// exact; with a point or an exponent they are as exact as a double.
std::optional<std::int64_t> parse_whole(std::string_view text);

// What is wrong with a text that is no number, to follow "must be a number, not '1,5'"; may be empty.
std::string number_hint(std::string_view text);

// Is it "nan", ".inf" or the like, or too large for a double?
bool means_not_finite(std::string_view text);

}  // namespace firn::config
