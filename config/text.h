#pragma once

// The characters of a text: is it text at all, and where is line 7, column 3.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "config/diagnostics.h"

namespace firn::config {

// A text cut into lines. Columns count characters (code points of UTF-8), not bytes.
class Lines {
 public:
  Lines(std::string_view text, std::string file);

  // From a line and a byte within it, both counted from 0.
  [[nodiscard]] Place place(int line, int byte) const;
  [[nodiscard]] Place place(std::size_t offset) const;
  [[nodiscard]] std::size_t offset(int line, int byte) const;  // at most the length of the text

  // Line counted from 0, without its line break; empty outside the text.
  [[nodiscard]] std::string_view line(int number) const;

 private:
  std::string_view text_;
  std::string file_;
  [[nodiscard]] std::size_t characters(std::size_t offset) const;  // before it

  std::vector<std::size_t> starts_;
  std::vector<std::size_t>
      characters_;  // before every so many bytes: counting from the start of a long line each time takes too long
};

// Takes off a byte order mark and turns every kind of line break into \n.
std::string normalise(std::string_view text);

// Reports text that is not UTF-8 or holds control characters (as binary files do), once, at the first such byte.
bool is_text(std::string_view text, const Lines& lines, Diagnostics& diagnostics);

// Where the character that begins at `offset` ends; 0 where it is not valid UTF-8 (RFC 3629).
std::size_t character_end(std::string_view text, std::size_t offset);

// For error texts: on one line, in single quotes, cut after about 40 characters.
std::string quote(std::string_view text);

}  // namespace firn::config
