#include "config/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace firn::config {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t digits(std::string_view text, std::size_t at) {
  while (at < text.size() && is_digit(text[at])) ++at;
  return at;
}

// [-+]? ( \. digits | digits ( \. digits? )? ) ( [eE] [-+]? digits )? of the YAML core schema: the length of the longest such
// beginning, or 0.
std::size_t decimal_length(std::string_view text) {
  std::size_t at = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  const std::size_t whole = digits(text, at);
  std::size_t end = whole;
  if (whole < text.size() && text[whole] == '.') end = digits(text, whole + 1);
  const std::size_t points = end > whole ? 1 : 0;
  if (end - at <= points) return 0;
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    at = end + 1;
    if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
    const std::size_t exponent = digits(text, at);
    if (exponent > at) end = exponent;
  }
  return end;
}

bool is_decimal(std::string_view text) { return !text.empty() && decimal_length(text) == text.size(); }

std::string_view without_plus(std::string_view text) { return text.starts_with('+') ? text.substr(1) : text; }

// 0x and 0o numbers have no sign in the core schema.
std::optional<std::uint64_t> parse_prefixed(std::string_view text) {
  const int base = text.starts_with("0x") ? 16 : text.starts_with("0o") ? 8 : 0;
  if (base == 0 || text.size() < 3) return std::nullopt;
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 2, end, value, base);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

struct Conversion {
  double value = 0;
  bool too_large = false;
};

Conversion convert(std::string_view decimal) {
  const std::string_view text = without_plus(decimal);
  Conversion result;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), result.value);
  if (error == std::errc::result_out_of_range) {
    // Too large or too small? from_chars says neither; a number below 1 has its first digit that counts behind the point, moved by
    // the exponent.
    const std::size_t mark = text.find_first_of("eE");
    const std::string_view mantissa = text.substr(0, mark);
    const bool small =
        mark != std::string_view::npos ? text[mark + 1] == '-' : mantissa.find('.') < mantissa.find_first_of("123456789");
    result = {0, !small};
  }
  return result;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  if (const auto whole = parse_prefixed(text)) return static_cast<double>(*whole);
  if (!is_decimal(text)) return std::nullopt;
  const Conversion conversion = convert(text);
  if (conversion.too_large) return std::nullopt;
  return conversion.value;
}

std::optional<std::int64_t> parse_whole(std::string_view text) {
  constexpr double limit = 9223372036854775808.0;  // 2^63
  if (const auto whole = parse_prefixed(text)) {
    if (*whole > static_cast<std::uint64_t>(INT64_MAX)) return std::nullopt;
    return static_cast<std::int64_t>(*whole);
  }
  if (!is_decimal(text)) return std::nullopt;
  const std::string_view number = without_plus(text);
  std::int64_t exact = 0;
  const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), exact);
  if (stop == number.data() + number.size()) return error == std::errc() ? std::optional(exact) : std::nullopt;
  const Conversion conversion = convert(text);
  if (conversion.too_large || std::trunc(conversion.value) != conversion.value) return std::nullopt;
  if (conversion.value < -limit || conversion.value >= limit) return std::nullopt;
  return static_cast<std::int64_t>(conversion.value);
}

bool means_not_finite(std::string_view text) {
  if (is_decimal(text)) return convert(text).too_large;
  std::string word;
  for (const char c : text) word += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (word.starts_with('-') || word.starts_with('+')) word.erase(0, 1);
  if (word.starts_with('.')) word.erase(0, 1);
  constexpr std::array<std::string_view, 3> words = {"nan", "inf", "infinity"};
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string number_hint(std::string_view text) {
  const std::size_t length = decimal_length(text);
  if (length == 0 || length == text.size()) return "";
  const std::string_view number = text.substr(0, length);
  const std::string_view rest = text.substr(length);
  if (rest[0] == ',' && rest.size() > 1 && is_decimal(rest.substr(1)) && is_digit(rest[1])) {
    return fmt::format("; write a decimal point: {}.{}", number, rest.substr(1));
  }
  const std::string_view unit = rest.substr(std::min(rest.find_first_not_of(' '), rest.size()));
  const auto first = static_cast<unsigned char>(unit.empty() ? '\0' : unit[0]);
  const bool letter = (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z') || first == '%' || first >= 0x80;
  if (letter && std::none_of(unit.begin() + 1, unit.end(), [](char c) { return c == ' '; })) {
    return fmt::format("; write the number without a unit: {}", number);
  }
  return "";
}

}  // namespace firn::config
