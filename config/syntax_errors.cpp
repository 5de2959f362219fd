#include "config/syntax_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace firn::config {
namespace {

constexpr const char* tab_text = "a tab indents this line; YAML indents with spaces only";

// A tab in the indentation makes yaml-cpp complain about something later in that line or in the next one.
std::optional<Place> indenting_tab(int line, const Lines& lines) {
  for (const int number : {line, line - 1}) {
    const std::string_view text = lines.line(number);
    const std::size_t first = text.find_first_not_of(" \t");
    const std::size_t tab = text.find('\t');
    if (first != std::string_view::npos && tab < first) return lines.place(number, static_cast<int>(tab));
  }
  return std::nullopt;
}

std::string unclosed(const TreeBuilder& builder, Node::Kind kind, char opening, char closing) {
  const TreeBuilder::Open open = builder.innermost_open(kind, true);
  return fmt::format("',' or '{}' expected: the '{}' of line {}, column {} is still open", closing, opening, open.place.line,
                     open.place.column);
}

std::string misplaced(const TreeBuilder& builder, Node::Kind kind, const char* what) {
  const TreeBuilder::Open open = builder.innermost_open(kind, false);
  return fmt::format("only {} begun on line {} can stand here; check the indentation, and whether a text needs quotes", what,
                     open.place.line);
}

std::string unknown_token(std::string_view line, int column) {
  const auto byte = static_cast<std::size_t>(std::max(column, 0));
  if (byte < line.size()) {
    return fmt::format("a value cannot begin with {}; put quotes around it", quote(line.substr(byte, 1)));
  }
  return "something that is no YAML stands here; check the quotes and brackets";
}

struct Translation {
  const char* original;
  const char* text;
};

// Not constexpr: the texts are plain constants in yaml-cpp 0.8.
const std::array translations = {
    Translation{YAML::ErrorMsg::FLOW_END, "this closing bracket does not match the one opened before it, or none is open"},
    Translation{YAML::ErrorMsg::BLOCK_ENTRY, "a '- ' item cannot stand here; begin the list on a line of its own or write [a, b]"},
    Translation{YAML::ErrorMsg::MAP_KEY, "a key cannot stand here; check the indentation"},
    Translation{
        YAML::ErrorMsg::MAP_VALUE,
        "this ':' cannot stand here; the keys of a map need the same indentation, and a text that contains ': ' needs quotes"},
    Translation{YAML::ErrorMsg::DOC_IN_SCALAR, "'---' or '...' begins a line inside of a quoted text; is a quote not closed?"},
    Translation{YAML::ErrorMsg::TAB_IN_INDENTATION, tab_text},
    Translation{YAML::ErrorMsg::UNKNOWN_ANCHOR, "this alias ('*name') names nothing: no '&name' stands above it"},
    Translation{YAML::ErrorMsg::INVALID_HEX, "this escape in a double-quoted text needs hexadecimal digits (\\x41, \\u0041)"},
    Translation{YAML::ErrorMsg::INVALID_UNICODE, "this escape in a double-quoted text is no character of Unicode"},
    Translation{YAML::ErrorMsg::CHAR_IN_BLOCK, "only spaces, '+', '-', a digit or a comment may follow '|' or '>'"},
    Translation{YAML::ErrorMsg::ALIAS_NOT_FOUND, "a name must follow '*'; a text that begins with '*' needs quotes"},
    Translation{YAML::ErrorMsg::CHAR_IN_ALIAS, "a name must follow '*'; a text that begins with '*' needs quotes"},
    Translation{YAML::ErrorMsg::ANCHOR_NOT_FOUND, "a name must follow '&'; a text that begins with '&' needs quotes"},
    Translation{YAML::ErrorMsg::CHAR_IN_ANCHOR, "a name must follow '&'; a text that begins with '&' needs quotes"},
    Translation{YAML::ErrorMsg::TAG_WITH_NO_SUFFIX, "a name must follow '!'; a text that begins with '!' needs quotes"},
    Translation{YAML::ErrorMsg::END_OF_VERBATIM_TAG,
                "'>' expected at the end of the tag; a text that begins with '!' needs quotes"},
    Translation{YAML::ErrorMsg::CHAR_IN_TAG_HANDLE, "this is no tag; a text that begins with '!' needs quotes"},
    Translation{YAML::ErrorMsg::BAD_FILE, "lists and maps are nested too deep"},
};

// Over a tag, an anchor, spaces and comments to the value itself.
std::size_t skip_properties(std::string_view text, std::size_t at) {
  for (;;) {
    at = std::min(text.find_first_not_of(" \t\n", at), text.size());
    if (at == text.size()) return at;
    if (text[at] == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (text[at] == '&' || text[at] == '!') {
      at = std::min(text.find_first_of(" \t\n", at), text.size());
    } else {
      return at;
    }
  }
}

bool is_closed(std::string_view text, std::size_t at) {
  const char quote_mark = text[at];
  for (++at; at < text.size(); ++at) {
    if (quote_mark == '"' && text[at] == '\\') {
      ++at;
    } else if (text[at] == quote_mark) {
      const bool escaped = quote_mark == '\'' && at + 1 < text.size() && text[at + 1] == '\'';
      if (!escaped) return true;
      ++at;
    }
  }
  return false;
}

}  // namespace

std::optional<Place> unclosed_quote(std::string_view text, const TreeBuilder& builder, const Lines& lines) {
  const auto mark = builder.last_scalar();
  if (!mark) return std::nullopt;
  const std::size_t at = skip_properties(text, lines.offset(mark->line, mark->column));
  if (at == text.size() || (text[at] != '"' && text[at] != '\'') || is_closed(text, at)) return std::nullopt;
  return lines.place(at);
}

Diagnostic explain(const YAML::Exception& exception, const TreeBuilder& builder, const Lines& lines) {
  const auto is = [&](const char* message) { return std::string_view(exception.msg).starts_with(message); };
  const YAML::Mark& mark = exception.mark;
  Diagnostic result{Severity::error, lines.place(mark.line, mark.column), ""};
  const std::string_view line = lines.line(mark.line);
  const auto byte = static_cast<std::size_t>(std::max(mark.column, 0));

  if (const auto tab = indenting_tab(mark.line, lines)) {
    return {Severity::error, *tab, tab_text};
  }
  const bool flow_map = is(YAML::ErrorMsg::END_OF_MAP_FLOW);
  if (flow_map || is(YAML::ErrorMsg::END_OF_SEQ_FLOW)) {
    const auto kind = flow_map ? Node::Kind::map : Node::Kind::sequence;
    if (byte > 0 && line.substr(byte - 1, 2) == "${") {
      result.text = "'${...}' inside of [ ] or { } needs quotes: \"${name}\"";
      return result;
    }
    result.text = flow_map ? unclosed(builder, kind, '{', '}') : unclosed(builder, kind, '[', ']');
    // At the end of the text yaml-cpp knows no place.
    if (mark.line == 0 && mark.column == 0) result.place = builder.innermost_open(kind, true).place;
  } else if (is(YAML::ErrorMsg::END_OF_MAP)) {
    result.text = misplaced(builder, Node::Kind::map, "another 'key: value' of the map");
  } else if (is(YAML::ErrorMsg::END_OF_SEQ)) {
    result.text = misplaced(builder, Node::Kind::sequence, "another '- ' item of the list");
  } else if (is(YAML::ErrorMsg::EOF_IN_SCALAR)) {
    result.text = fmt::format("a quoted text that begins on line {} or below is never closed", builder.last_line());
  } else if (is(YAML::ErrorMsg::INVALID_ESCAPE)) {
    result.text = fmt::format("unknown escape '\\{}' in a double-quoted text; single quotes keep a backslash as it is",
                              exception.msg.substr(std::string_view(YAML::ErrorMsg::INVALID_ESCAPE).size()));
  } else if (is(YAML::ErrorMsg::UNKNOWN_TOKEN)) {
    result.text = unknown_token(line, mark.column);
  } else {
    const auto known =
        std::find_if(translations.begin(), translations.end(), [&](const auto& entry) { return is(entry.original); });
    result.text = known != translations.end() ? known->text : exception.msg;
  }
  return result;
}

}  // namespace firn::config
