#include "graph/stage_uses.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "config/nearest.h"
#include "config/reader.h"
#include "graph/merge.h"
#include "graph/stage_file.h"

namespace firn::graph {
namespace {

using config::Diagnostics;
using config::Entry;
using config::Node;
using config::Reader;

// A plan looks at each turn of a repeat by itself, so that every level doubles the work of planning.
constexpr int deepest_repeat = 5;
constexpr int most_stages = 10'000;  // of a phase; aliases multiply them quickly

// The same text, or the same number however it is written.
bool same_value(const Node& a, const Node& b) {
  if (a.kind != Node::Kind::scalar || b.kind != Node::Kind::scalar) return false;
  if (a.scalar == b.scalar) return true;
  Diagnostics not_told;
  const auto one = config::read_number(a, "", {}, not_told);
  const auto other = config::read_number(b, "", {}, not_told);
  return one && other && *one == *other;
}

class StageReader {
 public:
  StageReader(const Node& parameters, Diagnostics& diagnostics) : parameters_(parameters), diagnostics_(diagnostics) {}

  void items(const Node& list, const std::string& what, std::vector<Item>& items) {
    if (list.kind == Node::Kind::null) return;
    if (list.kind != Node::Kind::sequence) {
      diagnostics_.error(list.place, fmt::format("{} must be a list of stages, not {}", what, describe(list)));
      return;
    }
    for (const Node& node : list.items) item(node, items);
  }

 private:
  void item(const Node& node, std::vector<Item>& items) {
    if (++stages_ > most_stages) {
      if (stages_ == most_stages + 1)
        diagnostics_.error(node.place, fmt::format("more than {} stages in one phase of a pipeline", most_stages));
      return;
    }
    if (node.kind == Node::Kind::scalar) {
      items.push_back({named(node.scalar, node.place)});
    } else if (node.find("repeat") != nullptr) {
      repeat(node, items);
    } else if (node.find("group") != nullptr) {
      group(node, items);
    } else if (node.find("stage") != nullptr) {
      stage_by_key(node, items);
    } else if (node.kind == Node::Kind::map && node.entries.size() == 1) {
      const Entry& only = node.entries.front();
      StageUse use = named(only.key, only.place);
      options(only.value, {}, use);
      items.push_back({std::move(use)});
    } else if (node.kind == Node::Kind::map && node.entries.size() > 1) {
      diagnostics_.error(
          node.entries[1].place,
          fmt::format("'{}' beside '{}': one stage per list entry; options belong in the braces behind its name: '- {}: "
                      "{{{}: ...}}'",
                      node.entries[1].key, node.entries[0].key, node.entries[0].key, node.entries[1].key));
    } else {
      diagnostics_.error(
          node.place,
          fmt::format("expected a stage's name, '- stage: {{parameter: value}}', a repeat or a group, not {}", describe(node)));
    }
  }

  static StageUse named(const std::string& stage, const Place& place) {
    StageUse use;
    use.stage = use.label = is_stage_file(stage) ? beside(place, stage) : stage;
    use.place = place;
    return use;
  }

  void group(const Node& node, std::vector<Item>& items) {
    Reader reader(node, "a group", diagnostics_);
    reader.required_text("group");
    const bool wanted = when(reader.find("when"));
    std::vector<Item> stages;
    if (const Node* list = reader.require("stages")) this->items(*list, "stages", stages);
    reader.finish();
    append(std::move(stages), wanted, items);
  }

  static void append(std::vector<Item> stages, bool wanted, std::vector<Item>& items) {
    if (!wanted) each_use(stages, [](StageUse& use) { use.wanted = false; });
    items.insert(items.end(), std::move_iterator(stages.begin()), std::move_iterator(stages.end()));
  }

  // Whether `when` holds: {parameter: value}, {parameter: [one, or another]}, or several of them, which must all hold.
  bool when(const Node* condition) {
    if (condition == nullptr) return true;
    if (condition->kind != Node::Kind::map || condition->entries.empty()) {
      diagnostics_.error(condition->place,
                         fmt::format("when must be a map of the pipeline's parameters to values such as {{kernel: cubic}}, not {}",
                                     describe(*condition)));
      return true;
    }
    bool holds = true;
    for (const Entry& e : condition->entries) {
      const Node* parameter = parameters_.find(e.key);
      if (parameter == nullptr) {
        std::vector<std::string> known;
        for (const Entry& p : parameters_.entries) known.push_back(p.key);
        diagnostics_.error(
            e.place, known.empty() ? fmt::format("when asks for '{}', but this pipeline has no parameters of its own", e.key)
                                   : fmt::format("no parameter '{}' in this pipeline{}", e.key, config::suggestion(e.key, known)));
        continue;
      }
      const std::vector<Node> values = e.value.kind == Node::Kind::sequence ? e.value.items : std::vector<Node>{e.value};
      for (const Node& value : values)
        if (value.kind != Node::Kind::scalar)
          diagnostics_.error(
              value.place, fmt::format("when compares '{}' with a value or a list of values, not with {}", e.key, describe(value)));
      holds = holds && std::ranges::any_of(values, [&](const Node& value) { return same_value(value, *parameter); });
    }
    return holds;
  }

  void stage_by_key(const Node& node, std::vector<Item>& items) {
    const Node& stage = *node.find("stage");
    const auto text = config::read_text(stage, "stage", diagnostics_);
    if (!text) return;
    StageUse use = named(*text, stage.place);
    options(node, {"stage"}, use);
    items.push_back({std::move(use)});
  }

  void options(const Node& map, const std::set<std::string>& skip, StageUse& use) {
    if (map.kind == Node::Kind::null) return;
    if (map.kind != Node::Kind::map) {
      diagnostics_.error(
          map.place, fmt::format("the options of {} must be a map such as {{parameter: value}}, not {}", use.stage, describe(map)));
      return;
    }
    for (const Entry& e : map.entries) {
      if (!skip.contains(e.key)) option(e, use);
    }
  }

 public:
  // One option of a stage: bind, every, enable, as, when; everything else is one of its parameters.
  void option(const Entry& e, StageUse& use) {
    if (e.key == "bind") {
      bind(e.value, use);
    } else if (e.key == "every") {
      use.every = config::read_integer(e.value, "every", {.min = 1, .max = 1e9}, diagnostics_).value_or(1);
    } else if (e.key == "enable") {
      use.enabled = config::read_boolean(e.value, "enable", diagnostics_).value_or(true);
    } else if (e.key == "when") {
      use.wanted = when(&e.value);
    } else if (e.key == "as") {
      use.label = config::read_text(e.value, "as", diagnostics_).value_or(use.label);
    } else {
      const auto same = std::ranges::find(use.parameters, e.key, &Entry::key);
      if (same != use.parameters.end())
        *same = e;
      else
        use.parameters.push_back(e);
    }
  }

 private:
  void bind(const Node& map, StageUse& use) {
    if (map.kind != Node::Kind::map) {
      diagnostics_.error(map.place,
                         fmt::format("bind must be a map of ports to buffers such as {{port: buffer}}, not {}", describe(map)));
      return;
    }
    for (const Entry& e : map.entries)
      if (const auto buffer = config::read_text(e.value, "the buffer of port " + e.key, diagnostics_))
        use.bindings.push_back({e.key, *buffer, e.place});
  }

  void repeat(const Node& node, std::vector<Item>& items) {
    Reader reader(node, "a repeat", diagnostics_);
    RepeatUse use;
    use.place = node.place;
    const config::Range turns{.min = 1, .max = 1e6};
    const Node* how = reader.find("repeat");
    if (how->kind == Node::Kind::map) {
      Reader options(*how, "repeat", diagnostics_);
      if (const Node* max = options.require("max")) use.max = config::read_integer(*max, "max", turns, diagnostics_).value_or(1);
      if (const Node* until = options.find("until")) {
        Reader limit(*until, "until", diagnostics_);
        Until condition;
        condition.place = until->place;
        condition.buffer = limit.required_text("buffer");
        condition.below = limit.required_number("below");
        limit.finish();
        use.until.push_back(condition);
      }
      options.finish();
    } else {
      use.max = config::read_integer(*how, "repeat", turns, diagnostics_).value_or(1);
    }
    ++depth_;
    if (depth_ == deepest_repeat + 1)
      diagnostics_.error(node.place, fmt::format("repeats stand in one another more than {} deep", deepest_repeat));
    const Node* stages = reader.require("stages");
    if (stages != nullptr && depth_ <= deepest_repeat) this->items(*stages, "stages", use.stages);
    --depth_;
    const bool wanted = when(reader.find("when"));
    reader.finish();
    std::vector<Item> one;
    one.push_back({std::move(use)});
    append(std::move(one), wanted, items);
  }

  const Node& parameters_;
  Diagnostics& diagnostics_;
  int depth_ = 0, stages_ = 0;
};

}  // namespace

void read_items(const Node& list, const std::string& what, const Node& parameters, std::vector<Item>& items,
                Diagnostics& diagnostics) {
  StageReader(parameters, diagnostics).items(list, what, items);
}

void read_option(const Entry& option, const Node& parameters, StageUse& use, Diagnostics& diagnostics) {
  StageReader(parameters, diagnostics).option(option, use);
}

void each_use(std::vector<Item>& items, const std::function<void(StageUse&)>& visit) {
  for (Item& item : items) {
    if (auto* use = std::get_if<StageUse>(&item.what)) visit(*use);
    if (auto* repeat = std::get_if<RepeatUse>(&item.what)) each_use(repeat->stages, visit);
  }
}

}  // namespace firn::graph
