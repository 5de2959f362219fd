#include "config/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace firn::config {
namespace {

constexpr std::size_t block = 256;

unsigned char byte_at(std::string_view text, std::size_t offset) { return static_cast<unsigned char>(text[offset]); }

bool is_continuation(unsigned char byte) { return (byte & 0xC0) == 0x80; }

bool begins_character(char c) { return !is_continuation(static_cast<unsigned char>(c)); }

bool is_control(unsigned char byte) { return (byte < 0x20 && byte != '\t' && byte != '\n') || byte == 0x7F; }

}  // namespace

Lines::Lines(std::string_view text, std::string file) : text_(text), file_(std::move(file)), starts_{0} {
  std::size_t count = 0;
  for (std::size_t offset = 0; offset < text.size(); ++offset) {
    if (offset % block == 0) characters_.push_back(count);
    if (begins_character(text[offset])) ++count;
    if (text[offset] == '\n') starts_.push_back(offset + 1);
  }
  characters_.push_back(count);
}

std::size_t Lines::characters(std::size_t offset) const {
  const std::size_t first = offset / block;
  const std::string_view rest = text_.substr(first * block, offset - first * block);
  return characters_[first] + static_cast<std::size_t>(std::count_if(rest.begin(), rest.end(), begins_character));
}

Place Lines::place(int line, int byte) const {
  const std::size_t start = offset(line, 0);
  const std::size_t end = std::min(offset(line, byte), start + this->line(line).size());
  return {file_, std::max(line, 0) + 1, static_cast<int>(characters(end) - characters(start)) + 1};
}

Place Lines::place(std::size_t offset) const {
  const auto next = std::upper_bound(starts_.begin(), starts_.end(), offset);
  const auto line = std::distance(starts_.begin(), next) - 1;
  return place(static_cast<int>(line), static_cast<int>(offset - starts_[static_cast<std::size_t>(line)]));
}

std::size_t Lines::offset(int line, int byte) const {
  if (line < 0 || static_cast<std::size_t>(line) >= starts_.size()) return text_.size();
  return std::min(starts_[static_cast<std::size_t>(line)] + static_cast<std::size_t>(std::max(byte, 0)), text_.size());
}

std::string_view Lines::line(int number) const {
  if (number < 0 || static_cast<std::size_t>(number) >= starts_.size()) return {};
  const std::size_t start = starts_[static_cast<std::size_t>(number)];
  const std::size_t next = static_cast<std::size_t>(number) + 1;
  const std::size_t end = next < starts_.size() ? starts_[next] - 1 : text_.size();
  return text_.substr(start, end - start);
}

std::string normalise(std::string_view text) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  std::string result;
  result.reserve(text.size());
  for (std::size_t offset = 0; offset < text.size(); ++offset) {
    if (text[offset] != '\r') {
      result += text[offset];
    } else if (offset + 1 == text.size() || text[offset + 1] != '\n') {
      result += '\n';
    }
  }
  return result;
}

std::size_t character_end(std::string_view text, std::size_t offset) {
  const unsigned char first = byte_at(text, offset);
  if (first < 0x80) return offset + 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() - offset < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (!is_continuation(byte_at(text, offset + i))) return 0;
  }
  // Overlong forms, surrogates and what lies beyond U+10FFFF show in the second byte.
  const unsigned char second = byte_at(text, offset + 1);
  const bool bad = (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) || (first == 0xF0 && second < 0x90) ||
                   (first == 0xF4 && second > 0x8F);
  return bad ? 0 : offset + length;
}

bool is_text(std::string_view text, const Lines& lines, Diagnostics& diagnostics) {
  for (std::size_t offset = 0; offset < text.size();) {
    const std::size_t next = character_end(text, offset);
    if (next == 0 || is_control(byte_at(text, offset))) {
      const bool utf16 = text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
      diagnostics.error(lines.place(offset), fmt::format("this is not a text in UTF-8: byte 0x{:02x} {}{}", byte_at(text, offset),
                                                         next == 0 ? "is part of no character" : "is a control character",
                                                         utf16 ? "; it looks like UTF-16, save it as UTF-8" : ""));
      return false;
    }
    offset = next;
  }
  return true;
}

std::string quote(std::string_view text) {
  constexpr std::size_t most = 40;
  std::string result = "'";
  for (std::size_t offset = 0; offset < text.size();) {
    if (result.size() > most) return result + "...'";
    const std::size_t next = character_end(text, offset);
    const unsigned char byte = byte_at(text, offset);
    if (byte == '\n') {
      result += "\\n";
    } else if (byte == '\t') {
      result += "\\t";
    } else if (next == 0 || is_control(byte)) {
      result += fmt::format("\\x{:02x}", byte);
    } else {
      result += text.substr(offset, next - offset);
    }
    offset = next == 0 ? offset + 1 : next;
  }
  return result + "'";
}

}  // namespace firn::config
