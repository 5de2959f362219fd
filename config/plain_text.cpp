#include "config/plain_text.h"

#include <algorithm>
#include <array>

namespace firn::config {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

}  // namespace

bool can_be_plain(std::string_view text) {
  constexpr std::array<std::string_view, 4> null_words = {"~", "null", "Null", "NULL"};
  if (text.empty() || is_blank(text.front()) || is_blank(text.back()) || text.back() == ':') return false;
  if (std::find(null_words.begin(), null_words.end(), text) != null_words.end()) return false;
  if (text.starts_with("---") || text.starts_with("...")) return false;
  if (std::string_view(",[]{}#&*!|>'\"%@`").find(text.front()) != std::string_view::npos) return false;
  if (std::string_view("-?:").find(text.front()) != std::string_view::npos && (text.size() == 1 || is_blank(text[1]))) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte < 0x20 && byte != '\t') || byte == 0x7F) return false;
    if (text[i] == ':' && is_blank(text[i + 1])) return false;  // ':' is never the last
    if (text[i] == '#' && is_blank(text[i - 1])) return false;  // '#' is never the first
  }
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  return text.find(byte_order_mark) == std::string_view::npos;
}

}  // namespace firn::config
