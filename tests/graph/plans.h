#pragma once

// Plans written as short texts, for tests of barriers.
//
//   "setup init x:write step scatter g:accumulate; repeat 4 until r { solve r:write } frame draw x:read:vertex"
//
// After a phase's name come its commands, each a stage with its accesses `buffer:access[:usage]`, storage where no usage is given.
// Buffers whose names begin with "image" are textures. Barriers may be given in brackets: "a x:write [uniform] b x:read:uniform".

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "graph/barriers.h"
#include "graph/plan.h"

namespace firn::test {

class PlanText {
 public:
  explicit PlanText(const std::string& text) {
    std::istringstream words(text);
    for (std::string word; words >> word;) {
      const bool ends = word.size() > 1 && word.back() == ';';
      if (ends) word.pop_back();
      words_.push_back(word);
      if (ends) words_.emplace_back(";");
    }
  }

  graph::Plan plan() {
    while (at_ < words_.size()) {
      const std::string phase = next();
      if (phase != "setup" && phase != "step" && phase != "frame") throw std::logic_error("a phase, not " + phase);
      (phase == "setup" ? plan_.setup : phase == "step" ? plan_.step : plan_.frame) = ops();
    }
    return plan_;
  }

 private:
  [[nodiscard]] std::string peek() const { return at_ < words_.size() ? words_[at_] : std::string{}; }
  std::string next() { return words_.at(at_++); }
  [[nodiscard]] bool at_end_of_ops() const {
    const std::string word = peek();
    return word.empty() || word == "}" || word == "setup" || word == "step" || word == "frame";
  }

  graph::Barrier barrier() {
    graph::Barrier made;
    for (bool more = true; more;) {
      std::string word = next();
      more = word.back() != ']';
      std::erase_if(word, [](char c) { return c == '[' || c == ']'; });
      for (unsigned bit = 0; bit < 11; ++bit)
        if (graph::bit_names(1u << bit).front() == word) made.bits |= 1u << bit;
    }
    return made;
  }

  std::vector<graph::Op> ops() {
    std::vector<graph::Op> list;
    while (!at_end_of_ops()) {
      if (peek() == ";") {
        next();
      } else if (peek().front() == '[') {
        list.emplace_back().what = barrier();
      } else if (peek() == "repeat") {
        next();
        graph::Repeat repeat;
        repeat.max = std::stoll(next());
        if (peek() == "until") {
          next();
          repeat.until = graph::PlannedUntil{buffer(next()), 0.5, -1};
        }
        next();  // {
        repeat.body = ops();
        next();  // }
        list.emplace_back().what = repeat;
      } else {
        list.emplace_back().what = run();
      }
    }
    return list;
  }

  graph::Run run() {
    graph::Run command;
    const std::string label = next();
    const auto known = std::ranges::find(plan_.stages, label, &graph::PlannedStage::label);
    command.stage = static_cast<int>(known - plan_.stages.begin());
    if (known == plan_.stages.end()) plan_.stages.emplace_back().label = label;
    while (!at_end_of_ops() && peek() != ";" && peek().front() != '[') {
      std::istringstream word(next());
      std::string name, access, usage = "storage";
      std::getline(word, name, ':');
      std::getline(word, access, ':');
      if (!word.eof()) std::getline(word, usage);
      command.accesses.push_back({buffer(name), graph::access(access).value(), graph::usage(usage).value()});
    }
    return command;
  }

  int buffer(const std::string& name) {
    const int known = plan_.buffer(name);
    if (known >= 0) return known;
    graph::PlannedBuffer& made = plan_.buffers.emplace_back();
    made.name = name;
    made.storage = static_cast<int>(plan_.buffers.size()) - 1;
    made.texture = name.starts_with("image");
    return static_cast<int>(plan_.buffers.size()) - 1;
  }

  std::vector<std::string> words_;
  std::size_t at_ = 0;
  graph::Plan plan_;
};

inline std::string text_of(const graph::Plan& plan, const std::vector<graph::Op>& ops, bool with_accesses) {
  std::vector<std::string> words;
  for (const graph::Op& op : ops) {
    if (const auto* barrier = std::get_if<graph::Barrier>(&op.what))
      words.push_back(fmt::format("[{}]", fmt::join(graph::bit_names(barrier->bits), " ")));
    if (const auto* run = std::get_if<graph::Run>(&op.what)) {
      std::string word = plan.stages[static_cast<std::size_t>(run->stage)].label;
      if (with_accesses)
        for (const graph::BufferAccess& access : run->accesses)
          word += fmt::format(" {}:{}:{}", plan.buffers[static_cast<std::size_t>(access.buffer)].name, name(access.access),
                              name(access.usage));
      words.push_back(word + (with_accesses ? ";" : ""));
    }
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) {
      // Where the device decides, the body's last command tells so itself.
      const std::string until = repeat->until && repeat->until->progress < 0
                                    ? fmt::format("until {} ", plan.buffers[static_cast<std::size_t>(repeat->until->buffer)].name)
                                    : "";
      words.push_back(fmt::format("repeat {} {}{{ {} }}", repeat->max, until, text_of(plan, repeat->body, with_accesses)));
    }
  }
  return fmt::format("{}", fmt::join(words, " "));
}

// The commands' labels with the barriers' bits between them, phase by phase; phases without anything are left out.
inline std::string text_of(const graph::Plan& plan, bool with_accesses = false) {
  std::vector<std::string> phases;
  for (const auto& [phase, ops] : {std::pair{"setup", &plan.setup}, {"step", &plan.step}, {"frame", &plan.frame}})
    if (!ops->empty()) phases.push_back(fmt::format("{} {}", phase, text_of(plan, *ops, with_accesses)));
  return fmt::format("{}", fmt::join(phases, " "));
}

inline graph::Plan placed(const std::string& text) {
  graph::Plan plan = PlanText(text).plan();
  graph::place_barriers(plan);
  return plan;
}

}  // namespace firn::test
