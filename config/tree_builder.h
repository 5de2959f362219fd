#pragma once

// From the events of yaml-cpp to a tree of nodes.

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/mark.h>

#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "config/node.h"
#include "config/text.h"

namespace firn::config {

constexpr int deepest_nesting = 100;
constexpr std::size_t most_nodes = 200'000;                               // keys count, copies made by aliases too
constexpr std::size_t most_copied_bytes = std::size_t{64} * 1024 * 1024;  // of text, by aliases and parameters

// Thrown by the builder to leave the parser.
struct Stop {
  YAML::Mark mark;
  std::string text;
};

// The nodes of one document lie in one list in the order of the text, so that an alias copies a range of it and deep or endless
// texts are seen before they cost anything.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const Lines& lines, Diagnostics& diagnostics) : lines_(lines), diagnostics_(diagnostics) {}

  // The tree as far as the events came; reports duplicate keys and keys that are no text. Where an error stopped the parser, what
  // it last said of keys may be wrong, and keys that are no text are passed over.
  Node tree(bool complete);

  // The list or map that is open where the events stopped; its place is where it began. `flow`: in brackets.
  struct Open {
    Place place;
    bool flow = false;
  };
  [[nodiscard]] Open innermost_open(Node::Kind kind, bool flow) const;
  [[nodiscard]] std::optional<Place> outermost_open_bracket() const;
  [[nodiscard]] int last_line() const;                          // of the last event, from 1
  [[nodiscard]] std::optional<YAML::Mark> last_scalar() const;  // where it, or its tag or anchor, begins
  [[nodiscard]] bool has_document() const { return documents_ > 0; }

  void OnDocumentStart(const YAML::Mark& mark) override;
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& value) override;
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override;
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YAML::EmitterStyle::value style) override;
  void OnMapEnd() override { close(); }

 private:
  struct Element {
    Node::Kind kind = Node::Kind::null;
    YAML::Mark mark;
    std::string text;
    std::size_t end = 0;  // just behind the last descendant; 0 while open
    int level = 0;        // lists and maps around it
    bool quoted = false;
    bool flow = false;
    bool copied = false;  // by an alias: what is wrong with it was said where it stands
  };

  Element& add(Node::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor);
  void open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
            YAML::EmitterStyle::value style);
  void close();
  void check_tag(const YAML::Mark& mark, const std::string& tag, const char* expected);
  void check_room(const YAML::Mark& mark, std::size_t more) const;
  Node build(std::size_t& next) const;
  void build_entries(Node& node, std::size_t& next, const Element& map) const;
  [[nodiscard]] std::string key_problem(const Node& key, const Element& key_element, std::size_t value, const Element& map) const;
  [[nodiscard]] Place place(const YAML::Mark& mark) const { return lines_.place(mark.line, mark.column); }

  const Lines& lines_;
  Diagnostics& diagnostics_;
  std::vector<Element> elements_;
  std::vector<std::size_t> open_;
  std::unordered_map<YAML::anchor_t, std::size_t> anchors_;
  std::size_t copied_bytes_ = 0;
  int documents_ = 0;
  bool complete_ = true;
};

}  // namespace firn::config
