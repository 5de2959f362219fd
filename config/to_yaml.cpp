#include <fmt/format.h>

#include "config/node.h"
#include "config/plain_text.h"

namespace firn::config {
namespace {

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else if (byte < 0x20 || byte == 0x7F) {
      result += fmt::format("\\x{:02x}", byte);
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string one_line(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "null";
    case Node::Kind::scalar:
      return !node.quoted && can_be_plain(node.scalar) ? node.scalar : in_quotes(node.scalar);
    case Node::Kind::sequence:
      return "[]";
    case Node::Kind::map:
      return "{}";
  }
  return "null";
}

void write(const Node& node, std::size_t indentation, std::string& out);

// What follows "- " or "key:", a line break at the end.
void write_below(const Node& node, std::size_t indentation, std::string& out) {
  if (node.items.empty() && node.entries.empty()) {
    out += ' ' + one_line(node) + '\n';
  } else {
    out += '\n';
    write(node, indentation, out);
  }
}

void write_key(const std::string& key, std::size_t indentation, std::string& out) {
  constexpr std::size_t longest_simple_key = 200;  // YAML allows 1024 characters, escapes counted
  const std::string text = key != "<<" && can_be_plain(key) ? key : in_quotes(key);
  if (text.size() <= longest_simple_key) {
    out += text + ':';
  } else {
    out += "? " + text + '\n' + std::string(indentation, ' ') + ':';
  }
}

void write(const Node& node, std::size_t indentation, std::string& out) {
  const std::string spaces(indentation, ' ');
  for (const Node& item : node.items) {
    out += spaces + '-';
    write_below(item, indentation + 2, out);
  }
  for (const Entry& entry : node.entries) {
    out += spaces;
    write_key(entry.key, indentation, out);
    write_below(entry.value, indentation + 2, out);
  }
}

}  // namespace

std::string to_yaml(const Node& node) {
  if (node.items.empty() && node.entries.empty()) return one_line(node) + '\n';
  std::string out;
  write(node, 0, out);
  return out;
}

}  // namespace firn::config
