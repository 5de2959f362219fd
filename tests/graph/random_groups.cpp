#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <functional>
#include <map>
#include <random>
#include <set>

#include "graph/compile.h"
#include "tests/catch.h"
#include "tests/graph/executions.h"
#include "tests/graph/loaded.h"
#include "tests/graph/made_up.h"

// Random pipelines as files: groups in groups, repeats, conditions, includes, replaced and disabled stages. What is left of them is
// worked out here a second time, on the tree that the files were written from.

namespace firn::test {
namespace {

struct Part {
  enum class Kind { stage, group, repeat } kind = Kind::stage;
  std::string name;  // of a stage or a group
  int turns = 1;
  bool until = false;
  int every = 1;
  bool enabled = true;
  std::vector<std::string> modes = {};  // `when`: the values of the parameter `mode` that it takes part with; none: all
  std::vector<Part> inner = {};
};
using Parts = std::vector<Part>;

std::string flow_of(const Parts& parts);

std::string flow_of(const Part& part) {
  std::vector<std::string> options;
  if (part.every > 1) options.push_back(fmt::format("every: {}", part.every));
  if (!part.enabled) options.emplace_back("enable: false");
  if (part.modes.size() == 1) options.push_back(fmt::format("when: {{mode: {}}}", part.modes.front()));
  if (part.modes.size() > 1) options.push_back(fmt::format("when: {{mode: [{}]}}", fmt::join(part.modes, ", ")));
  if (part.kind == Part::Kind::stage)
    return options.empty() ? part.name : fmt::format("{{{}: {{{}}}}}", part.name, fmt::join(options, ", "));
  std::string head = fmt::format("group: {}", part.name);
  if (part.kind == Part::Kind::repeat)
    head = part.until ? fmt::format("repeat: {{max: {}, until: {{buffer: rest, below: 0.5}}}}", part.turns)
                      : fmt::format("repeat: {}", part.turns);
  return fmt::format("{{{}{}{}, stages: {}}}", head, options.empty() ? "" : ", ", fmt::join(options, ", "), flow_of(part.inner));
}

std::string flow_of(const Parts& parts) {
  std::vector<std::string> texts;
  for (const Part& part : parts) texts.push_back(flow_of(part));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

void replace(Parts& parts, const std::string& group, const Parts& by) {
  for (Part& part : parts)
    if (part.kind == Part::Kind::group && part.name == group)
      part.inner = by;
    else
      replace(part.inner, group, by);
}

void groups_in(const Parts& parts, std::set<std::string>& names) {
  for (const Part& part : parts) {
    if (part.kind == Part::Kind::group) names.insert(part.name);
    groups_in(part.inner, names);
  }
}

// The stages that a tree comes to, with their labels: "a b#2 repeat 3 until { a#2 }".
class Remaining {
 public:
  Remaining(std::string mode, std::set<std::string> disabled) : mode_(std::move(mode)), disabled_(std::move(disabled)) {}

  std::string of(const Parts& parts, bool wanted = true) {
    std::vector<std::string> words;
    for (const Part& part : parts) {
      const bool takes_part = wanted && (part.modes.empty() || std::ranges::count(part.modes, mode_) > 0);
      if (part.kind == Part::Kind::stage) {
        const int number = ++uses_[part.name];
        const std::string label = number == 1 ? part.name : fmt::format("{}#{}", part.name, number);
        if (takes_part && part.enabled && !disabled_.contains(part.name) && !disabled_.contains(label)) words.push_back(label);
        continue;
      }
      const std::string inner = of(part.inner, takes_part);
      if (inner.empty()) continue;
      words.push_back(part.kind == Part::Kind::group
                          ? inner
                          : fmt::format("repeat {}{} {{ {} }}", part.turns, part.until ? " until" : "", inner));
    }
    return fmt::format("{}", fmt::join(words, " "));
  }

 private:
  std::string mode_;
  std::set<std::string> disabled_;
  std::map<std::string, int> uses_;
};

std::string text_without_barriers(const graph::Plan& plan, const std::vector<graph::Op>& ops) {
  std::vector<std::string> words;
  for (const graph::Op& op : ops) {
    if (const auto* run = std::get_if<graph::Run>(&op.what); run != nullptr && run->work == 0)
      words.push_back(plan.stages[static_cast<std::size_t>(run->stage)].label);
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what))
      words.push_back(fmt::format("repeat {}{} {{ {} }}", repeat->max, repeat->until ? " until" : "",
                                  text_without_barriers(plan, repeat->body)));
  }
  return fmt::format("{}", fmt::join(words, " "));
}

class RandomPipeline {
 public:
  explicit RandomPipeline(std::uint64_t seed) : random_(seed) {
    make_stages();
    Parts step = parts(4, 0), frame = parts(2, 0);
    const std::string base_step = flow_of(step), base_frame = flow_of(frame);
    folder.write("parts/base.yaml", fmt::format("firn: 1\nparameters: {{mode: {}}}\nsetup: [fill]\nstep: {}\nframe: {}\n", mode(),
                                                base_step, base_frame));
    folder.write("parts/middle.yaml", fmt::format("firn: 1\ninclude: base.yaml\n{}", replacements(step, frame)));
    std::string own_mode = mode();
    std::string top =
        fmt::format("firn: 1\ninclude: parts/middle.yaml\nparameters: {{mode: {}}}\n{}", own_mode, replacements(step, frame));
    folder.write("p.yaml", top);
    if (below(2) == 0) {
      own_mode = mode();
      edits.set = set({"mode=" + own_mode}).set;
    }
    std::set<std::string> groups;
    groups_in(step, groups);
    if (!groups.empty() && below(3) == 0) replace_by_command(*groups.begin(), step, frame);
    if (below(3) == 0) edits.disable = {fmt::format("s{}", below(stages))};
    // A label or a stage that no use has is an error of its own.
    if (const std::string everything = everything_in(step) + everything_in(frame);
        !edits.disable.empty() && everything.find(" " + edits.disable[0] + " ") == std::string::npos)
      edits.disable.clear();
    Remaining remaining(own_mode, {edits.disable.begin(), edits.disable.end()});
    expected = "fill | " + remaining.of(step);
    expected += " | " + remaining.of(frame);
  }

  Folder folder;
  graph::Edits edits;
  graph::Registry registry;
  std::string expected;

 private:
  static constexpr int stages = 8;

  int below(int limit) { return std::uniform_int_distribution<int>(0, limit - 1)(random_); }
  std::string mode() { return std::string(1, static_cast<char>('a' + below(3))); }

  static std::string everything_in(const Parts& parts) {
    std::string names = " ";
    for (const Part& part : parts) names += part.kind == Part::Kind::stage ? part.name + " " : everything_in(part.inner);
    return names;
  }

  void make_stages() {
    using enum graph::Access;
    using graph::Usage;
    const std::vector<std::pair<graph::Access, Usage>> ways{{read, Usage::storage},       {write, Usage::storage},
                                                            {read_write, Usage::storage}, {accumulate, Usage::storage},
                                                            {read, Usage::uniform},       {read, Usage::sampled}};
    const std::vector<std::pair<graph::Access, Usage>> ways_of_images{
        {read, Usage::image}, {write, Usage::image}, {read_write, Usage::image}, {read, Usage::sampled}};
    const std::vector<std::string> buffers{"x", "y", "z"};
    std::vector<graph::Port> all{port("rest", write, "1"), port("image", write, "cells", graph::ElementType::float1, Usage::image)};
    for (const std::string& buffer : buffers) all.push_back(port(buffer, write, "points", graph::ElementType::vec4));
    registry.add(stage("fill", all));
    for (int s = 0; s < stages; ++s) {
      std::vector<graph::Port> ports;
      for (const std::string& buffer : buffers)
        if (below(2) == 0) {
          const auto [access, usage] = ways[static_cast<std::size_t>(below(static_cast<int>(ways.size())))];
          ports.push_back(port(buffer, access, "points", graph::ElementType::vec4, usage));
        }
      if (below(3) == 0) {
        const auto [access, usage] = ways_of_images[static_cast<std::size_t>(below(static_cast<int>(ways_of_images.size())))];
        ports.push_back(port("image", access, "cells", graph::ElementType::float1, usage));
      }
      if (ports.empty() || below(4) == 0) ports.push_back(port("rest", below(2) == 0 ? write : read, "1"));
      graph::StageSpec spec = stage(fmt::format("s{}", s), ports);
      if (below(3) == 0) spec.work.emplace_back(graph::Dispatch{.kernel = "second.comp", .over = "points"});
      registry.add(spec);
    }
  }

  Parts parts(int most, int depth) {
    Parts list;
    for (int count = 1 + below(most); count > 0; --count) {
      Part part;
      if (below(4) == 0)
        for (const char* one : {"a", "b", "c"})
          if (below(2) == 0) part.modes.emplace_back(one);
      const int kind = depth < 3 ? below(5) : 4;
      if (kind == 0) {
        part.kind = Part::Kind::repeat;
        part.turns = 1 + below(3);
        part.until = below(2) == 0;
        part.inner = parts(2, depth + 1);
      } else if (kind == 1) {
        part.kind = Part::Kind::group;
        part.name = fmt::format("g{}", below(4));
        part.inner = parts(3, depth + 1);
      } else {
        part.name = fmt::format("s{}", below(stages));
        if (below(6) == 0) part.every = 2;
        part.enabled = below(6) != 0;
      }
      list.push_back(part);
    }
    return list;
  }

  // The key `replace` for groups that are there, done to the tree as well.
  std::string replacements(Parts& step, Parts& frame) {
    std::vector<std::string> entries;
    std::set<std::string> told;
    for (int count = below(3); count > 0; --count) {
      std::set<std::string> groups;
      groups_in(step, groups);
      groups_in(frame, groups);
      if (groups.empty()) break;
      const std::string group = *std::next(groups.begin(), below(static_cast<int>(groups.size())));
      if (!told.insert(group).second) continue;
      const Parts by = parts(3, 2);
      replace(step, group, by);
      replace(frame, group, by);
      entries.push_back(fmt::format("  {}: {}\n", group, flow_of(by)));
    }
    return entries.empty() ? "" : fmt::format("replace:\n{}", fmt::join(entries, ""));
  }

  void replace_by_command(const std::string& group, Parts& step, Parts& frame) {
    const Part only{.name = fmt::format("s{}", below(stages))};
    replace(step, group, {only});
    replace(frame, group, {only});
    config::Node name;
    name.kind = config::Node::Kind::scalar;
    name.scalar = only.name;
    config::Node list;
    list.kind = config::Node::Kind::sequence;
    list.items = {name};
    edits.replace.emplace_back(group, list);
  }

  std::mt19937_64 random_;
};

TEST_CASE("random pipelines of groups, repeats, includes and replacements come to the stages they say, free of hazards") {
  const std::uint64_t first = seed(), count = std::getenv("FIRN_LONG") != nullptr ? 20'000 : 400;
  int with_repeats = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const RandomPipeline random(first + i);
    config::Diagnostics diagnostics;
    const graph::PipelineSpec pipeline = graph::load_pipeline(random.folder.path() / "p.yaml", random.edits, diagnostics);
    const auto plan = [&](const graph::PlanOptions& options) {
      return graph::compile(pipeline, random.registry, made_up_environment(), diagnostics, options);
    };
    const graph::Plan by_host = plan({});
    INFO("seed " << first + i << "\n" << fmt::format("{}", fmt::join(random.folder.texts(diagnostics), "\n")));
    if (diagnostics.has_errors()) {
      FAIL_CHECK("it is refused");
      return;
    }
    const std::string phases = text_without_barriers(by_host, by_host.setup) + " | " +
                               text_without_barriers(by_host, by_host.step) + " | " + text_without_barriers(by_host, by_host.frame);
    REQUIRE(phases == random.expected);
    with_repeats += phases.find("repeat") != std::string::npos ? 1 : 0;
    graph::Plan made = plan({.share_memory = i % 2 == 0, .decide_on_device = i % 4 < 2});
    REQUIRE(fault_of(made, 3, first + i) == "");
  }
  CHECK(with_repeats > static_cast<int>(count) / 10);
  SUCCEED("seeds " << first << " to " << first + count - 1);
}

}  // namespace
}  // namespace firn::test
