#include <fmt/format.h>

#include <cstddef>

#include "config/nearest.h"
#include "config/node.h"
#include "config/places.h"
#include "config/text.h"
#include "config/tree_builder.h"

namespace firn::config {
namespace {

struct Size {
  std::size_t nodes = 0;
  std::size_t bytes = 0;  // of text
};

void measure(const Node& node, Size& size) {
  ++size.nodes;
  size.bytes += node.scalar.size();
  for (const Node& item : node.items) measure(item, size);
  for (const Entry& entry : node.entries) {
    size.bytes += entry.key.size();
    measure(entry.value, size);
  }
}

bool refers(const Node& node) {
  if (node.scalar.find("${") != std::string::npos) return true;
  for (const Node& item : node.items) {
    if (refers(item)) return true;
  }
  for (const Entry& entry : node.entries) {
    if (refers(entry.value)) return true;
  }
  return false;
}

class Substitution {
 public:
  Substitution(const Node& parameters, Diagnostics& diagnostics) : parameters_(parameters), diagnostics_(diagnostics) {
    for (const Entry& entry : parameters.entries) names_.push_back(entry.key);
  }

  void run(Node& node) {
    if (node.kind == Node::Kind::scalar) {
      scalar(node);
      return;
    }
    for (Node& item : node.items) run(item);
    for (Entry& entry : node.entries) run(entry.value);
  }

 private:
  void scalar(Node& node) {
    const std::string text = node.scalar;
    if (text.find("${") == std::string::npos) return;
    if (text.starts_with("${") && text.find('}') == text.size() - 1) {
      whole(node, text.substr(2, text.size() - 3));
      return;
    }
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
      if (text.compare(at, 3, "$${") == 0) {
        result += "${";
        at += 3;
      } else if (text.compare(at, 2, "${") == 0) {
        const std::size_t end = text.find('}', at);
        if (end == std::string::npos) {
          diagnostics_.error(node.place,
                             fmt::format("'}}' is missing after '${{' in {}; '$${{' stands for the characters '${{'", quote(text)));
          return;
        }
        result += part(node, text.substr(at + 2, end - at - 2));
        at = end + 1;
      } else {
        result += text[at++];
      }
    }
    node.scalar = result;
  }

  const Node* find(const Node& use, const std::string& name) {
    const Node* value = parameters_.find(name);
    if (value == nullptr) {
      const std::string help = names_.empty() ? "; there are no parameters" : suggestion(name, names_);
      diagnostics_.error(use.place, fmt::format("unknown parameter {}{}", quote(name), help));
    } else if (refers(*value)) {
      diagnostics_.error(use.place,
                         fmt::format("parameter {} contains '${{' itself; a parameter cannot be made of others", quote(name)));
      value = nullptr;
    }
    return value;
  }

  [[nodiscard]] bool fits() const { return used_.nodes <= most_nodes && used_.bytes <= most_copied_bytes; }

  // So that a long list of uses of a long list cannot fill the memory.
  bool has_room(const Node& use, const Size& more) {
    const bool had_room = fits();
    used_.nodes += more.nodes;
    used_.bytes += more.bytes;
    if (fits()) return true;
    if (had_room) diagnostics_.error(use.place, fmt::format("parameters put in more than {} values or 64 MiB of text", most_nodes));
    return false;
  }

  void whole(Node& node, const std::string& name) {
    const Node* value = find(node, name);
    if (value == nullptr) return;
    Size size;
    measure(*value, size);
    if (!has_room(node, size)) return;
    const Place place = node.place;
    node = Node(*value);
    put_at(node, place);
  }

  std::string part(const Node& use, const std::string& name) {
    const Node* value = find(use, name);
    if (value == nullptr) return "";
    if (value->kind != Node::Kind::scalar) {
      diagnostics_.error(use.place,
                         fmt::format("parameter {} is {}, so it cannot be part of a text", quote(name), describe(*value)));
      return "";
    }
    return has_room(use, {0, value->scalar.size()}) ? value->scalar : "";
  }

  const Node parameters_;  // a copy: they may be a part of the tree that is changed
  Diagnostics& diagnostics_;
  std::vector<std::string> names_;
  Size used_;
};

}  // namespace

void substitute(Node& node, const Node& parameters, Diagnostics& diagnostics) { Substitution(parameters, diagnostics).run(node); }

}  // namespace firn::config
