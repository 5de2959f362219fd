#pragma once

// Pipelines as read, written back as short texts.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <utility>
#include <vector>

#include "graph/pipeline.h"
#include "tests/graph/folder.h"

namespace firn::test {

struct Loaded {
  graph::PipelineSpec pipeline;
  Lines messages;
};

inline Loaded loaded(const Folder& folder, const std::string& file, const graph::Edits& edits = {}) {
  config::Diagnostics diagnostics;
  graph::PipelineSpec pipeline = graph::load_pipeline(folder.path() / file, edits, diagnostics);
  return {std::move(pipeline), folder.texts(diagnostics)};
}

inline Loaded loaded(const std::string& yaml, const graph::Edits& edits = {}) {
  const Folder folder;
  folder.write("p.yaml", yaml);
  return loaded(folder, "p.yaml", edits);
}

inline Lines load_messages(const std::string& yaml, const graph::Edits& edits = {}) { return loaded(yaml, edits).messages; }

// Words of the command line.
inline graph::Edits set(const std::vector<std::string>& words) {
  graph::Edits edits;
  config::Diagnostics diagnostics;
  for (const std::string& word : words) edits.set.push_back(config::parse_override(word, diagnostics));
  config::throw_if_errors(diagnostics);
  return edits;
}

inline std::string flow(const config::Node& node) {
  std::vector<std::string> parts;
  for (const config::Node& item : node.items) parts.push_back(flow(item));
  for (const config::Entry& entry : node.entries) parts.push_back(entry.key + ": " + flow(entry.value));
  switch (node.kind) {
    case config::Node::Kind::sequence:
      return fmt::format("[{}]", fmt::join(parts, ", "));
    case config::Node::Kind::map:
      return fmt::format("{{{}}}", fmt::join(parts, ", "));
    default:
      return node.scalar;
  }
}

// "label(parameter=value port>buffer every=2 off)", "repeat 4 until x<0.5 [...]".
inline std::string text_of(const std::vector<graph::Item>& items) {
  std::vector<std::string> words;
  for (const graph::Item& item : items) {
    if (const auto* use = std::get_if<graph::StageUse>(&item.what)) {
      std::vector<std::string> options;
      if (use->stage != use->label) options.push_back("stage=" + use->stage);
      for (const config::Entry& parameter : use->parameters) options.push_back(parameter.key + "=" + flow(parameter.value));
      for (const graph::Binding& binding : use->bindings) options.push_back(binding.port + ">" + binding.buffer);
      if (use->every != 1) options.push_back(fmt::format("every={}", use->every));
      if (!use->enabled) options.emplace_back("off");
      words.push_back(options.empty() ? use->label : fmt::format("{}({})", use->label, fmt::join(options, " ")));
    }
    if (const auto* repeat = std::get_if<graph::RepeatUse>(&item.what)) {
      std::string until;
      for (const graph::Until& limit : repeat->until) until += fmt::format("until {}<{} ", limit.buffer, limit.below);
      words.push_back(fmt::format("repeat {} {}[{}]", repeat->max, until, text_of(repeat->stages)));
    }
  }
  return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace firn::test
