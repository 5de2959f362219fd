#include <ctime>
#include <string>

#include "graph/barriers.h"
#include "tests/catch.h"
#include "tests/graph/loaded.h"
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
  }
  for (const std::string& name : {longest + ".comp", std::string("circle.comp")}) {
    folder.write("p.yaml", "firn: 1\nstep: [" + name + "]\n");
    CHECK(tells(loaded(folder, "p.yaml").messages, "p.yaml:2:8: error: no such stage file"));
  }
}

TEST_CASE("repeats in repeats are planned five deep and refused deeper") {
  const auto nested = [](int depth) {
    std::string stages = "demo.fill";
    for (int i = 0; i < depth; ++i) stages = "{repeat: 2, stages: [" + stages + "]}";
    return load_messages("firn: 1\nstep: [" + stages + "]\n");
  };
  CHECK(nested(5) == Lines{});
  const Lines refused = nested(6);
  REQUIRE(refused.size() == 1);
  CHECK(refused[0].find("repeats stand in one another more than 5 deep") != std::string::npos);
}

TEST_CASE("more than ten thousand stages in a phase are refused, once") {
  std::string text = "firn: 1\nstep:\n  - group: first\n    stages: &many [demo.fill";
  for (int i = 1; i < 100; ++i) text += ", demo.fill";
  text += "]\n";
  for (int i = 1; i < 99; ++i) text += "  - {group: more, stages: *many}\n";
  CHECK(load_messages(text) == Lines{});
  text += "  - {group: last, stages: *many}\n";
  const Lines refused = load_messages(text);
  REQUIRE(refused.size() == 1);
  CHECK(refused[0].find("more than 10000 stages") != std::string::npos);
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
