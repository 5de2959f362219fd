#include <algorithm>
#include <ctime>
#include <string>

#include "graph/barriers.h"
#include "tests/catch.h"
#include "tests/graph/loaded.h"
#include "tests/graph/made_up.h"
#include "tests/graph/plans.h"

// Files that ask for too much: refused at once, or done in a moment.

namespace firn::test {
namespace {

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

bool tells(const Lines& messages, const std::string& fragment) {
  return std::ranges::any_of(messages, [&](const std::string& line) { return line.find(fragment) != std::string::npos; });
}

TEST_CASE("names that no file system takes and circles of links name no file") {
  const Folder folder;
  const std::string longest(5000, 'a');
  std::filesystem::create_symlink("circle.yaml", folder.path() / "circle.yaml");
  std::filesystem::create_symlink("circle.comp", folder.path() / "circle.comp");
  for (const std::string& name : {longest, std::string("circle.yaml")}) {
    folder.write("p.yaml", "firn: 1\ninclude: " + name + "\nstep: [demo.fill]\n");
    const Lines messages = loaded(folder, "p.yaml").messages;
    CHECK(tells(messages, "p.yaml:2:10: error: no such file"));
    CHECK(tells(messages, "; its symbolic links go in a circle") == (name == "circle.yaml"));
  }
  for (const std::string& name : {longest + ".comp", std::string("circle.comp")}) {
    folder.write("p.yaml", "firn: 1\nstep: [" + name + "]\n");
    const Lines messages = loaded(folder, "p.yaml").messages;
    CHECK(tells(messages, "p.yaml:2:8: error: no such stage file"));
    CHECK(tells(messages, "; its symbolic links go in a circle") == (name == "circle.comp"));
  }
}

TEST_CASE("repeats in repeats are planned five deep and refused deeper") {
  const auto nested = [](int depth) {
    std::string stages = "demo.fill";
    for (int i = 0; i < depth; ++i) stages = "{repeat: 2, stages: [" + stages + "]}";
    return load_messages("firn: 1\nstep: [" + stages + "]\n");
  };
  CHECK(nested(5).empty());
  const Lines refused = nested(6);
  REQUIRE(refused.size() == 1);
  CHECK(refused[0].find("repeats stand in one another more than 5 deep") != std::string::npos);
}

TEST_CASE("more than ten thousand stages in a phase are refused, once") {
  std::string text = "firn: 1\nstep:\n  - group: first\n    stages: &many [demo.fill";
  for (int i = 1; i < 100; ++i) text += ", demo.fill";
  text += "]\n";
  for (int i = 1; i < 99; ++i) text += "  - {group: more, stages: *many}\n";
  CHECK(load_messages(text).empty());
  text += "  - {group: last, stages: *many}\n";
  const Lines refused = load_messages(text);
  REQUIRE(refused.size() == 1);
  CHECK(refused[0].find("more than 10000 stages") != std::string::npos);
}

TEST_CASE("ten thousand uses of one stage get their labels in a moment") {
  std::string text = "firn: 1\nstep:\n  - group: first\n    stages: &many [demo.fill";
  for (int i = 1; i < 100; ++i) text += ", demo.fill";
  text += "]\n";
  for (int i = 1; i < 99; ++i) text += "  - {group: more, stages: *many}\n";
  const double start = processor_seconds();
  CHECK(text_of(loaded(text).pipeline.step).ends_with("demo.fill#9900(stage=demo.fill)"));
  CHECK(processor_seconds() - start < 2);
}

TEST_CASE("a group may be replaced by a list with a group of its own name") {
  const Loaded result =
      loaded("firn: 1\nstep: [{group: a, stages: [demo.fill]}]\nreplace: {a: [{group: a, stages: [demo.look]}]}\n");
  CHECK(result.messages.empty());
  CHECK(text_of(result.pipeline.step) == "demo.look");
}

TEST_CASE("replacements that would fill the memory are refused") {
  std::string text = "firn: 1\nstep:\n";
  for (int i = 0; i < 1000; ++i) text += "  - {group: a, stages: []}\n";
  text += "replace:\n  a: [demo.fill";
  for (int i = 0; i < 1000; ++i) text += ", demo.fill";
  const Lines refused = load_messages(text + "]\n");
  REQUIRE(!refused.empty());
  CHECK(refused[0].find("replacing 'a' makes more than 200000 values and keys") != std::string::npos);

  text = "firn: 1\nstep: [demo.fill]\nreplace:\n";
  for (int i = 0; i < 201; ++i) text += "  g" + std::to_string(i) + ": []\n";
  CHECK(tells(load_messages(text), "more than 200 groups are replaced"));
}

TEST_CASE("more than a thousand parameters, two thousand buffers or a hundred ports are refused") {
  std::string text = "firn: 1\nparameters:\n";
  for (int i = 0; i < 1001; ++i) text += "  p" + std::to_string(i) + ": 1\n";
  CHECK(tells(load_messages(text + "step: [demo.fill]\n"), "more than 1000 parameters"));

  text = "firn: 1\nstep:\n";
  for (int i = 0; i < 2002; ++i) text += "  - demo.fill: {bind: {x: x" + std::to_string(i) + "}}\n";
  int told = 0;
  for (const std::string& line : messages(text)) told += line.find("more than 2000 buffers") != std::string::npos ? 1 : 0;
  CHECK(told == 1);

  const Folder folder;
  text = "/*\nfirn: 1\nname: many\ndoc: d\nports:\n";
  for (int i = 0; i < 101; ++i)
    text += "  p" + std::to_string(i) + ": {type: float, domain: points, access: read, unit: m, doc: d}\n";
  folder.write("many.comp", text + "over: points\n*/\nvoid main() {}\n");
  folder.write("p.yaml", "firn: 1\nstep: [./many.comp]\n");
  CHECK(tells(loaded(folder, "p.yaml").messages, "has more than 100 ports"));
}

TEST_CASE("barriers of thousands of stages are placed in a moment") {
  std::string text = "step a x:write y:accumulate";
  for (int i = 0; i < 1500; ++i) text += "; b x:read z:write; c z:read:uniform x:write; d y:read; e y:accumulate";
  graph::Plan plan = PlanText(text).plan();
  const double start = processor_seconds();
  graph::place_barriers(plan);
  CHECK(processor_seconds() - start < 2);
}

}  // namespace
}  // namespace firn::test
