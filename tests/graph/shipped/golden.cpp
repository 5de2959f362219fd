#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>

#include "tests/catch.h"
#include "tests/graph/shipped/shipped.h"

// What the shipped pipelines become, kept as texts under tests/graph/golden/. A change there is a change of what runs: look at it,
// and write the files anew with
//
//   FIRN_GOLDEN=write build/tests/test_graph_shipped "plans of shipped pipelines are as they were"

namespace firn::test {
namespace {

std::string kind_of(const graph::Work& work) {
  if (const auto* dispatch = std::get_if<graph::Dispatch>(&work)) {
    // Stages that are files have whole paths, which differ between machines.
    std::string kernel = dispatch->kernel;
    if (const std::string root = source_folder().string() + "/"; kernel.starts_with(root)) kernel.erase(0, root.size());
    return fmt::format("dispatch {} over {}", kernel, dispatch->over.empty() ? dispatch->indirect : dispatch->over);
  }
  if (const auto* draw = std::get_if<graph::Draw>(&work)) return "draw " + draw->name;
  return "host";
}

void write_ops(const graph::Plan& plan, const std::vector<graph::Op>& ops, const std::string& indent, std::string& text) {
  const auto name = [&](int buffer) { return plan.buffers[static_cast<std::size_t>(buffer)].name; };
  for (const graph::Op& op : ops) {
    if (const auto* barrier = std::get_if<graph::Barrier>(&op.what)) {
      text += fmt::format("{}barrier {}\n", indent, fmt::join(graph::bit_names(barrier->bits), " "));
      for (const std::string& reason : barrier->reasons) text += fmt::format("{}  for {}\n", indent, reason);
    } else if (const auto* run = std::get_if<graph::Run>(&op.what)) {
      const graph::PlannedStage& stage = plan.stages[static_cast<std::size_t>(run->stage)];
      const std::string every = stage.every == 1 ? "" : fmt::format(" every {}", stage.every);
      text +=
          fmt::format("{}{}{}: {}\n", indent, stage.label, every, kind_of(stage.spec.work[static_cast<std::size_t>(run->work)]));
      for (const graph::BufferAccess& access : run->accesses)
        text +=
            fmt::format("{}  {} {} as {}\n", indent, graph::name(access.access), name(access.buffer), graph::name(access.usage));
    } else if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) {
      const auto& until = repeat->until;
      const std::string end = until ? fmt::format(" until {} < {:g} by the {}", name(until->buffer), until->below,
                                                  until->progress < 0 ? "host" : "device")
                                    : "";
      text += fmt::format("{}repeat {}{}\n", indent, repeat->max, end);
      write_ops(plan, repeat->body, indent + "  ", text);
    }
  }
}

// Sizes are left out: they are the scene's.
std::string text_of(const graph::Plan& plan) {
  std::string text = fmt::format("pipeline {}\n", plan.pipeline);
  for (const graph::PlannedBuffer& buffer : plan.buffers) {
    const std::string& storage = plan.buffers[static_cast<std::size_t>(buffer.storage)].name;
    text +=
        fmt::format("buffer {}: {}, {} of {}, {}{}\n", buffer.name, graph::name(buffer.type), buffer.texture ? "texture" : "array",
                    buffer.domain, buffer.lifetime == graph::Lifetime::scratch ? "scratch" : "state",
                    storage == buffer.name ? "" : ", in the memory of " + storage);
  }
  for (const auto& [phase, ops] : {std::pair{"setup", &plan.setup}, {"step", &plan.step}, {"frame", &plan.frame}}) {
    text += fmt::format("{}\n", phase);
    write_ops(plan, *ops, "  ", text);
  }
  return text;
}

bool ends_by_itself(const std::vector<graph::Op>& ops) {
  return std::ranges::any_of(ops, [](const graph::Op& op) {
    const auto* repeat = std::get_if<graph::Repeat>(&op.what);
    return repeat != nullptr && (repeat->until || ends_by_itself(repeat->body));
  });
}

// The first line in which two texts differ.
std::string difference(const std::string& golden, const std::string& text) {
  const auto lines = [](const std::string& of) {
    std::vector<std::string> list;
    std::string line;
    for (const char c : of) {
      if (c != '\n') line += c;
      if (c == '\n') list.push_back(std::exchange(line, {}));
    }
    return list;
  };
  const std::vector<std::string> before = lines(golden), now = lines(text);
  for (std::size_t i = 0; i < std::max(before.size(), now.size()); ++i) {
    const std::string was = i < before.size() ? before[i] : "(end)", is = i < now.size() ? now[i] : "(end)";
    if (was != is) return fmt::format("line {}: was '{}', is '{}'", i + 1, was, is);
  }
  return "";
}

TEST_CASE("plans of shipped pipelines are as they were") {
  const char* mode = std::getenv("FIRN_GOLDEN");
  const bool write = mode != nullptr && std::string(mode) == "write";
  for (const std::string& name : shipped_pipelines()) {
    const Shipped shipped(name);
    for (const bool by_device : {false, true}) {
      const graph::Plan plan = shipped.plan({.share_memory = true, .decide_on_device = by_device});
      if (by_device && !ends_by_itself(plan.step)) continue;
      std::string file = name.substr(0, name.size() - std::string(".yaml").size()) + (by_device ? ".device.txt" : ".txt");
      std::ranges::replace(file, '/', '.');
      const std::filesystem::path path = source_folder() / "tests" / "graph" / "golden" / file;
      const std::string text = text_of(plan);
      if (write) std::ofstream(path) << text;
      std::ifstream stream(path);
      const std::string golden{std::istreambuf_iterator<char>(stream), {}};
      INFO("golden/" << file << "; see golden.cpp for how to write it anew");
      CHECK(difference(golden, text) == "");
    }
  }
}

}  // namespace
}  // namespace firn::test
