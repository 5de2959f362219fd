#include "config/tree_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "config/plain_text.h"

namespace firn::config {
namespace {

constexpr std::string_view core_prefix = "tag:yaml.org,2002:";

// yaml-cpp says "?" where a value has no tag and no quotes, "!" where it has quotes.
bool has_tag(const std::string& tag) { return !tag.empty() && tag != "?" && tag != "!"; }

bool is_core(const std::string& tag, std::string_view name) {
  return tag.size() == core_prefix.size() + name.size() && tag.starts_with(core_prefix) && tag.ends_with(name);
}

std::string written(const std::string& tag) { return tag.starts_with(core_prefix) ? "!!" + tag.substr(core_prefix.size()) : tag; }

// yaml-cpp makes a lone byte, which is no UTF-8, of the escapes \N (U+0085) and \_ (U+00A0).
std::string with_whole_characters(const std::string& value) {
  std::string result;
  for (std::size_t at = 0; at < value.size();) {
    const std::size_t end = character_end(value, at);
    if (end == 0) result += '\xC2';
    result.append(value, at, end == 0 ? 1 : end - at);
    at = end == 0 ? at + 1 : end;
  }
  return result;
}

bool has_value_indicator(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == ':' && (i + 1 == line.size() || line[i + 1] == ' ' || line[i + 1] == '\t')) return true;
  }
  return false;
}

}  // namespace

void TreeBuilder::OnDocumentStart(const YAML::Mark& mark) {
  if (++documents_ < 2) return;
  const std::string_view line = lines_.line(mark.line);
  const bool marked = mark.column == 0 && line.starts_with("---");
  throw Stop{mark, marked ? "a second document begins here; a file holds one only, remove the '---'"
                          : "this does not belong to what stands above; check the indentation and brackets"};
}

void TreeBuilder::check_room(const YAML::Mark& mark, std::size_t more) const {
  if (elements_.size() + more > most_nodes) {
    throw Stop{mark, fmt::format("more than {} values and keys, copies made by aliases ('*name') included", most_nodes)};
  }
}

TreeBuilder::Element& TreeBuilder::add(Node::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
  check_room(mark, 1);
  if (anchor != YAML::NullAnchor) anchors_[anchor] = elements_.size();
  Element element;
  element.kind = kind;
  element.mark = mark;
  element.level = static_cast<int>(open_.size());
  element.end = elements_.size() + 1;
  return elements_.emplace_back(std::move(element));
}

void TreeBuilder::check_tag(const YAML::Mark& mark, const std::string& tag, const char* expected) {
  if (!has_tag(tag) || is_core(tag, expected)) return;
  diagnostics_.error(place(mark), fmt::format("the tag {} means nothing here; remove it", quote(written(tag))));
}

void TreeBuilder::OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) { add(Node::Kind::null, mark, anchor); }

void TreeBuilder::OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& value) {
  constexpr std::array<std::string_view, 5> null_words = {"", "~", "null", "Null", "NULL"};
  const bool null = is_core(tag, "null") && std::find(null_words.begin(), null_words.end(), value) != null_words.end();
  Element& element = add(null ? Node::Kind::null : Node::Kind::scalar, mark, anchor);
  if (null) return;
  element.text = with_whole_characters(value);
  // A text over several lines or '-' in brackets had no quotes, but is nothing else than text either.
  element.quoted = tag == "!" || is_core(tag, "str") || !can_be_plain(value);
  constexpr std::array<const char*, 3> plain = {"int", "float", "bool"};
  if (std::none_of(plain.begin(), plain.end(), [&](const char* name) { return is_core(tag, name); })) check_tag(mark, tag, "str");
}

void TreeBuilder::open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) {
  if (static_cast<int>(open_.size()) >= deepest_nesting) {
    throw Stop{mark, fmt::format("lists and maps are nested more than {} deep", deepest_nesting)};
  }
  Element& element = add(kind, mark, anchor);
  element.end = 0;
  element.flow = style == YAML::EmitterStyle::Flow;
  open_.push_back(elements_.size() - 1);
  check_tag(mark, tag, kind == Node::Kind::map ? "map" : "seq");
}

void TreeBuilder::OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                                  YAML::EmitterStyle::value style) {
  open(Node::Kind::sequence, mark, tag, anchor, style);
}

void TreeBuilder::OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                             YAML::EmitterStyle::value style) {
  open(Node::Kind::map, mark, tag, anchor, style);
}

void TreeBuilder::close() {
  elements_[open_.back()].end = elements_.size();
  open_.pop_back();
}

void TreeBuilder::OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) {
  const auto found = anchors_.find(anchor);
  const std::size_t begin = found == anchors_.end() ? elements_.size() : found->second;
  const std::size_t end = found == anchors_.end() ? 0 : elements_[begin].end;
  if (end == 0) throw Stop{mark, "this alias stands inside of what it names, which would never end"};
  check_room(mark, end - begin);
  const int deeper = static_cast<int>(open_.size()) - elements_[begin].level;
  // Everything is checked before anything is copied: half a copy would be no tree.
  for (std::size_t i = begin; i < end; ++i) {
    const Element& element = elements_[i];
    const bool is_collection = element.kind == Node::Kind::sequence || element.kind == Node::Kind::map;
    if (is_collection && element.level + deeper >= deepest_nesting) {
      throw Stop{mark, fmt::format("this alias nests lists and maps more than {} deep", deepest_nesting)};
    }
    copied_bytes_ += element.text.size();
    if (copied_bytes_ > most_copied_bytes) throw Stop{mark, "aliases ('*name') copy more than 64 MiB of text"};
  }
  const std::size_t shift = elements_.size() - begin;
  for (std::size_t i = begin; i < end; ++i) {
    Element copy = elements_[i];
    copy.end += shift;
    copy.level += deeper;
    copy.copied = true;
    elements_.push_back(std::move(copy));
  }
}

Node TreeBuilder::tree(bool complete) {
  complete_ = complete;
  for (const std::size_t index : open_) elements_[index].end = elements_.size();
  std::size_t next = 0;
  return elements_.empty() ? Node{} : build(next);
}

Node TreeBuilder::build(std::size_t& next) const {
  const Element& element = elements_[next++];
  Node node;
  node.kind = element.kind;
  node.place = place(element.mark);
  node.scalar = element.text;
  node.quoted = element.quoted;
  if (element.kind == Node::Kind::sequence) {
    while (next < element.end) node.items.push_back(build(next));
  } else if (element.kind == Node::Kind::map) {
    build_entries(node, next, element);
  }
  return node;
}

std::string TreeBuilder::key_problem(const Node& key, const Element& key_element, std::size_t value, const Element& map) const {
  if (key.kind != Node::Kind::scalar) return fmt::format("a key must be a text, not {}", describe(key));
  if (key.scalar == "<<" && !key.quoted) return "merge keys ('<<') are not supported; write the keys out";
  // A line without ':' is a key to yaml-cpp; it then puts the empty value where the key stands, as it also does at the very end.
  const YAML::Mark& mark = key_element.mark;
  const std::string_view line = lines_.line(mark.line);
  const std::string_view rest = line.substr(std::min(static_cast<std::size_t>(mark.column), line.size()));
  const bool no_colon = !map.flow && value < map.end && elements_[value].kind == Node::Kind::null &&
                        elements_[value].mark.line == mark.line && elements_[value].mark.column == mark.column &&
                        !has_value_indicator(rest);
  if (!no_colon) return "";
  const bool joined = !key.quoted && key.scalar.find(':') != std::string::npos;
  return (joined ? "a space is missing after ':' in " : "':' is missing after the key ") + quote(key.scalar);
}

void TreeBuilder::build_entries(Node& node, std::size_t& next, const Element& map) const {
  std::unordered_map<std::string, int> lines;
  while (next < map.end) {
    const Element& key_element = elements_[next];
    const Node key = build(next);
    std::string problem = key_problem(key, key_element, next, map);
    Node value = next < map.end ? build(next) : Node{Node::Kind::null, key.place, "", false, {}, {}};
    // yaml-cpp places a value that is not there at whatever comes next.
    if (value.kind == Node::Kind::null && value.place.line != key.place.line) value.place = key.place;
    if (problem.empty()) {
      const auto [first, is_new] = lines.try_emplace(key.scalar, key.place.line);
      if (!is_new) problem = fmt::format("duplicate key {}: first given on line {}", quote(key.scalar), first->second);
    }
    if (problem.empty()) {
      node.entries.push_back({key.scalar, key.place, std::move(value)});
    } else if (!key_element.copied && (complete_ || key.kind == Node::Kind::scalar)) {
      diagnostics_.error(key.place, problem);
    }
  }
}

TreeBuilder::Open TreeBuilder::innermost_open(Node::Kind kind, bool flow) const {
  for (auto index = open_.rbegin(); index != open_.rend(); ++index) {
    const Element& element = elements_[*index];
    if (element.kind == kind && element.flow == flow) return {place(element.mark), flow};
  }
  return {};
}

std::optional<Place> TreeBuilder::outermost_open_bracket() const {
  const auto index = std::find_if(open_.begin(), open_.end(), [&](std::size_t open) { return elements_[open].flow; });
  return index == open_.end() ? std::nullopt : std::optional(place(elements_[*index].mark));
}

std::optional<YAML::Mark> TreeBuilder::last_scalar() const {
  const auto last = std::find_if(elements_.rbegin(), elements_.rend(),
                                 [](const Element& element) { return element.kind == Node::Kind::scalar && !element.copied; });
  return last == elements_.rend() ? std::nullopt : std::optional(last->mark);
}

int TreeBuilder::last_line() const { return elements_.empty() ? 1 : elements_.back().mark.line + 1; }

}  // namespace firn::config
