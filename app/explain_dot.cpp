#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "app/explain.h"

namespace firn::app {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string wrapped(const std::string& text, std::size_t width, const char* line_break) {
  std::string result;
  std::size_t column = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (column > 0 && column + word.size() > width) {
      result += line_break;
      column = 0;
    } else if (column > 0) {
      result += ' ';
    }
    result += escaped(word);
    column += word.size() + 1;
    begin = end + 1;
  }
  return result;
}

constexpr const char* red = "#b3261e";
constexpr const char* left = "<br align=\"left\"/>";

struct Box {  // one stage's turn; consecutive pieces of its work are rows
  std::string id;
  int stage = 0;
  std::string rows;
};

enum class Flow { same_phase, from_setup, step_before };

class Drawing {
 public:
  explicit Drawing(const graph::Plan& plan) : plan_(plan) {}

  std::string draw(const std::string& doc) {
    text_ = fmt::format(
        "digraph plan {{\n"
        "  graph [rankdir=TB, compound=true, newrank=true, nodesep=0.35, ranksep=0.3, fontname=\"Helvetica\", labelloc=t, "
        "fontsize=20,\n"
        "    label=<<b>{}</b><br/><font point-size=\"13\">{}</font>>];\n"
        "  node [shape=plain, fontname=\"Helvetica\", fontsize=11];\n"
        "  edge [fontname=\"Helvetica\", fontsize=9];\n",
        escaped(plan_.pipeline), wrapped(doc, 90, "<br/>"));
    legend();
    phase("setup", "setup: once", plan_.setup);
    remember_setup();
    phase("step", "step: again and again", plan_.step);
    phase("frame", "frame: for every picture", plan_.frame);
    edges();
    return text_ + "}\n";
  }

 private:
  void legend() {
    text_ += fmt::format(
        "  legend [label=<<table border=\"0\" cellborder=\"0\" cellspacing=\"3\">"
        "<tr><td align=\"left\">box: a stage, with its kernels in order</td></tr>"
        "<tr><td align=\"left\"><font color=\"{}\">&#9632; red: a barrier; what follows sees what was written "
        "before</font></td></tr>"
        "<tr><td align=\"left\"><font color=\"#1f5f99\">&#8594; blue: a buffer, from the stage that wrote it to one that reads "
        "it</font></td></tr>"
        "<tr><td align=\"left\"><font color=\"#b36b00\">&#8674; orange: the same, as the step before left it</font></td></tr>"
        "<tr><td align=\"left\"><font color=\"#808080\">&#8594; grey: as the setup left it</font></td></tr></table>>];\n",
        red);
  }

  void phase(const std::string& name, const std::string& title, const std::vector<graph::Op>& ops) {
    if (ops.empty()) return;
    text_ += fmt::format(
        "  subgraph cluster_{} {{\n    label=\"{}\"; labeljust=l; fontsize=15; style=\"rounded,filled\"; color=\"#c8d2dc\"; "
        "fillcolor=\"#f4f7fa\";\n",
        name, title);
    phase_ = name;
    spine_.clear();
    accesses_.clear();
    this->ops(ops, "    ");
    for (std::size_t i = 1; i < spine_.size(); ++i)
      text_ += fmt::format("    {} -> {} [weight=50, color=\"#404040\", penwidth=1.6, arrowsize=0.7];\n", spine_[i - 1], spine_[i]);
    text_ += "  }\n";
    if (!last_of_phase_.empty()) text_ += fmt::format("  {} -> {} [style=invis, weight=20];\n", last_of_phase_, spine_.front());
    last_of_phase_ = spine_.back();
    flows();
  }

  void ops(const std::vector<graph::Op>& ops, const std::string& indent) {
    Box box;
    const graph::Barrier* waiting = nullptr;
    const auto close = [&] {
      if (!box.id.empty()) emit(box, indent);
      box = {};
      if (waiting != nullptr) barrier(*waiting, indent);
      waiting = nullptr;
    };
    for (const graph::Op& op : ops) {
      if (const auto* barrier = std::get_if<graph::Barrier>(&op.what)) {
        waiting = barrier;
      } else if (const auto* run = std::get_if<graph::Run>(&op.what)) {
        if (box.id.empty() || box.stage != run->stage) {
          close();
          box = {fmt::format("n{}", ++nodes_), run->stage, ""};
        } else if (waiting != nullptr) {
          box.rows += barrier_row(*waiting);
          waiting = nullptr;
        }
        box.rows += row(*run);
        for (const graph::BufferAccess& access : run->accesses) accesses_.emplace_back(box.id, access);
      } else if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) {
        close();
        this->repeat(*repeat, indent);
      }
    }
    close();
  }

  void repeat(const graph::Repeat& repeat, const std::string& indent) {
    std::string title = fmt::format("repeat {} times", repeat.max);
    if (repeat.until)
      title = fmt::format("repeat until {} < {:g}, at most {} times", name(repeat.until->buffer), repeat.until->below, repeat.max);
    text_ += fmt::format(
        "{}subgraph cluster_repeat{} {{\n{}  label=\"{}\"; labeljust=l; fontsize=11; style=\"rounded,dashed,filled\"; "
        "color=\"#5b7083\"; fillcolor=\"#e6edf3\";\n",
        indent, ++repeats_, indent, escaped(title));
    const std::size_t first = spine_.size();
    ops(repeat.body, indent + "  ");
    text_ += indent + "}\n";
    if (spine_.size() > first)
      text_ += fmt::format("{}{} -> {} [constraint=false, style=dashed, color=\"#5b7083\", label=\"again\"];\n", indent,
                           spine_.back(), spine_[first]);
  }

  std::string row(const graph::Run& run) const {
    const graph::PlannedStage& stage = plan_.stages[static_cast<std::size_t>(run.stage)];
    const graph::Work& work = stage.spec.work[static_cast<std::size_t>(run.work)];
    std::string what = work_name(work);
    if (const auto* dispatch = std::get_if<graph::Dispatch>(&work))
      what += dispatch->over.empty() ? ", groups from " + dispatch->indirect : " over " + dispatch->over;
    else
      what = std::holds_alternative<graph::Draw>(work) ? "draws " + what : "runs on the host";
    return fmt::format("<tr><td align=\"left\"><font point-size=\"9\" color=\"#404040\">{}</font></td></tr>", escaped(what));
  }

  static std::string bits_of(const graph::Barrier& barrier) {
    return fmt::format("{}", fmt::join(graph::bit_names(barrier.bits), ", "));
  }

  static std::string barrier_row(const graph::Barrier& barrier) {
    return fmt::format("<tr><td align=\"left\"><font point-size=\"9\" color=\"{}\">&#9632; barrier: {}</font></td></tr>", red,
                       escaped(bits_of(barrier)));
  }

  void barrier(const graph::Barrier& barrier, const std::string& indent) {
    const std::string id = fmt::format("n{}", ++nodes_);
    std::string reasons;
    for (const std::string& reason : barrier.reasons) reasons += escaped(reason) + "&#10;";
    text_ += fmt::format(
        "{}{} [shape=box, style=filled, height=0.2, margin=\"0.08,0.03\", color=\"{}\", fillcolor=\"#fbe9e7\", fontcolor=\"{}\", "
        "fontsize=9, label=\"barrier: {}\", tooltip=\"{}\"];\n",
        indent, id, red, red, bits_of(barrier), reasons);
    spine_.push_back(id);
  }

  void emit(const Box& box, const std::string& indent) {
    const graph::PlannedStage& stage = plan_.stages[static_cast<std::size_t>(box.stage)];
    const std::string every = stage.every == 1 ? "" : fmt::format(" (every {}th time)", stage.every);
    text_ += fmt::format(
        "{}{} [tooltip=\"{}\", label=<<table border=\"1\" cellborder=\"0\" cellspacing=\"0\" cellpadding=\"2\" bgcolor=\"white\" "
        "color=\"#33475b\" style=\"rounded\"><tr><td align=\"left\"><b>{}</b>{}</td></tr><tr><td align=\"left\">"
        "<font point-size=\"9\" color=\"#5b7083\">{}</font></td></tr>{}</table>>];\n",
        indent, box.id, escaped(stage.spec.doc), escaped(stage.label), every, wrapped(stage.spec.doc, 46, left) + left, box.rows);
    spine_.push_back(box.id);
  }

  // Who reads what whom wrote, in the phase just drawn.
  void flows() {
    std::map<int, std::string> writers = phase_ == "frame" ? writers_ : std::map<int, std::string>{}, last;
    for (const auto& [box, access] : accesses_)
      if (graph::writes(access.access)) last[access.buffer] = box;
    for (const auto& [box, access] : accesses_) {
      if (graph::reads(access.access)) {
        if (const auto writer = writers.find(access.buffer); writer != writers.end()) {
          flow(writer->second, box, access.buffer, setup_boxes_.contains(writer->second) ? Flow::from_setup : Flow::same_phase);
        } else {
          if (const auto begun = writers_.find(access.buffer); begun != writers_.end())
            flow(begun->second, box, access.buffer, Flow::from_setup);
          if (const auto before = last.find(access.buffer); before != last.end() && phase_ == "step")
            flow(before->second, box, access.buffer, Flow::step_before);
        }
      }
      if (graph::writes(access.access)) writers[access.buffer] = box;
    }
    for (const auto& [buffer, box] : last) writers_[buffer] = box;
  }

  void flow(const std::string& from, const std::string& to, int buffer, Flow kind) {
    if (from == to) return;
    std::vector<std::string>& names = flows_[{from, to, kind}];
    if (std::ranges::find(names, name(buffer)) == names.end()) names.push_back(name(buffer));
  }

  void remember_setup() {
    for (const auto& [box, access] : accesses_) setup_boxes_.insert(box);
  }

  void edges() {
    for (const auto& [key, names] : flows_) {
      const auto& [from, to, kind] = key;
      const char* look = kind == Flow::same_phase   ? "color=\"#1f5f99\", fontcolor=\"#1f5f99\""
                         : kind == Flow::from_setup ? "color=\"#a0a0a0\", fontcolor=\"#707070\""
                                                    : "color=\"#b36b00\", fontcolor=\"#b36b00\", style=dashed, constraint=false";
      constexpr std::size_t shown = 6;
      std::vector<std::string> lines(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), shown)));
      if (names.size() > shown) lines.push_back(fmt::format("and {} more", names.size() - shown));
      text_ += fmt::format("  {} -> {} [{}, arrowsize=0.6, label=\"{}\", tooltip=\"{}\"];\n", from, to, look,
                           escaped(fmt::format("{}", fmt::join(lines, "\\n"))), escaped(fmt::format("{}", fmt::join(names, ", "))));
    }
  }

  [[nodiscard]] const std::string& name(int buffer) const { return plan_.buffers[static_cast<std::size_t>(buffer)].name; }

  const graph::Plan& plan_;
  std::string text_, phase_, last_of_phase_;
  int nodes_ = 0, repeats_ = 0;
  std::vector<std::string> spine_;                                     // nodes of the phase, in order
  std::vector<std::pair<std::string, graph::BufferAccess>> accesses_;  // of the phase, by box
  std::map<int, std::string> writers_;                                 // who wrote a buffer last, before the phase
  std::set<std::string> setup_boxes_;
  std::map<std::tuple<std::string, std::string, Flow>, std::vector<std::string>> flows_;
};

}  // namespace

std::string explain_as_dot(const graph::Plan& plan, const std::string& doc) { return Drawing(plan).draw(doc); }

}  // namespace firn::app
