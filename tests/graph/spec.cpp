#include "graph/spec.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/graph/made_up.h"

// Each mistake of a spec, made in one that is right.

namespace firn::test {
namespace {

using namespace graph;
using enum Access;

StageSpec right() {
  StageSpec spec =
      stage("demo.right", {port("x", read_write), port("y", read), port("counts", read, "3", ElementType::uint1, Usage::indirect)});
  spec.parameters = parameters_of_all_kinds();
  spec.work.emplace_back(Dispatch{.kernel = "two.comp", .over = "", .indirect = "counts", .uses = {{"x", read}}});
  spec.work.emplace_back(HostWork{.uses = {{"y", read}}});
  return spec;
}

Lines mistakes(const std::function<void(StageSpec&)>& make_mistake) {
  StageSpec spec = right();
  make_mistake(spec);
  return problems(spec);
}

TEST_CASE("a spec that is right has no problems") { CHECK(problems(right()) == Lines{}); }

TEST_CASE("name, doc and work are needed") {
  CHECK(mistakes([](StageSpec& spec) { spec.name = ""; }) == Lines{"has no name"});
  CHECK(mistakes([](StageSpec& spec) { spec.doc = ""; }) == Lines{"has no doc"});
  CHECK(mistakes([](StageSpec& spec) { spec.work.clear(); }) == Lines{"has no work"});
}

TEST_CASE("ports need a name of their own, a doc, a domain and a unit") {
  for (const std::string name : {"", "X", "2x", "a-b", "a b", "a.b"}) {
    CAPTURE(name);
    const Lines found = mistakes([&](StageSpec& spec) { spec.ports[1].name = name; });
    CHECK(std::ranges::count(found, "port " + name + ": its name may hold a-z, 0-9 and _") == 1);
  }
  CHECK(mistakes([](StageSpec& spec) { spec.ports[1].doc = ""; }) == Lines{"port y: has no doc"});
  CHECK(mistakes([](StageSpec& spec) { spec.ports[1].domain = ""; }) == Lines{"port y: has no domain"});
  CHECK(mistakes([](StageSpec& spec) { spec.ports[1].unit = ""; }) == Lines{"port y: has no unit"});
  CHECK(mistakes([](StageSpec& spec) { spec.ports.push_back(spec.ports[0]); }) == Lines{"port x: declared twice"});
}

TEST_CASE("one port may be declared once for each condition") {
  CHECK(mistakes([](StageSpec& spec) {
          spec.ports[1].when = {"kernel", "linear"};
          spec.ports.push_back(spec.ports[1]);
          spec.ports.back().when = {"kernel", "cubic"};
        }) == Lines{});
}

TEST_CASE("names that kernels or pipelines use are reserved") {
  for (const std::string name : {"dt", "time", "step", "frame"}) {
    CAPTURE(name);
    CHECK(mistakes([&](StageSpec& spec) { spec.ports.push_back(port(name, read)); }) ==
          Lines{"port " + name + ": its name is reserved"});
  }
  for (const std::string name : {"bind", "every", "enable", "as", "stage", "when", "dt", "time", "step", "frame"}) {
    CAPTURE(name);
    CHECK(mistakes([&](StageSpec& spec) { spec.parameters[0].name = name; }) ==
          Lines{"parameter " + name + ": its name is reserved"});
  }
}

TEST_CASE("parameters need a name of their own and a doc") {
  CHECK(mistakes([](StageSpec& spec) { spec.parameters[0].name = "Speed"; }) ==
        Lines{"parameter Speed: its name may hold a-z, 0-9 and _"});
  CHECK(mistakes([](StageSpec& spec) { spec.parameters[0].doc = ""; }) == Lines{"parameter speed: has no doc"});
  CHECK(mistakes([](StageSpec& spec) { spec.parameters[0].name = "turns"; }) == Lines{"parameter turns: the name is taken"});
  CHECK(mistakes([](StageSpec& spec) { spec.parameters[0].name = "x"; }) == Lines{"parameter x: the name is taken"});
}

TEST_CASE("defaults are of the parameter's kind and in its range") {
  const std::vector<Value> values{1.5, std::int64_t{2}, true, std::string("linear"), Vector3{}};
  const std::vector<std::string> texts{
      "speed: its default is no number in its range", "turns: its default is no whole number in its range",
      "wrap: its default is not true or false",       "kernel: its default is none of its choices",
      "push: its default is no vector in its range",  "file: its default is no text"};
  const std::vector<std::size_t> own{0, 1, 2, 3, 4, 3};
  for (std::size_t parameter = 0; parameter < texts.size(); ++parameter)
    for (std::size_t value = 0; value < values.size(); ++value) {
      CAPTURE(parameter, value);
      const Lines expected = value == own[parameter] ? Lines{} : Lines{"parameter " + texts[parameter]};
      CHECK(mistakes([&](StageSpec& spec) { spec.parameters[parameter].initial = values[value]; }) == expected);
    }
  for (const double outside : {-0.5, 10.5, std::numeric_limits<double>::quiet_NaN()})
    CHECK(mistakes([&](StageSpec& spec) { spec.parameters[0].initial = outside; }).size() == 1);
  for (const std::int64_t outside : {0, 9})
    CHECK(mistakes([&](StageSpec& spec) { spec.parameters[1].initial = outside; }).size() == 1);
  CHECK(mistakes([](StageSpec& spec) {
          spec.parameters[4].initial = Vector3{0, -6, 0};
        }) == Lines{"parameter push: its default is no vector in its range"});
  CHECK(mistakes([](StageSpec& spec) { spec.parameters[3].choices = {"linear", "cubic", "linear"}; }).size() == 1);
}

TEST_CASE("work uses ports that are there") {
  CHECK(mistakes([](StageSpec& spec) {
          spec.work[0] = Dispatch{.kernel = "k", .over = "points", .uses = {{"z", read}}};
        }) == Lines{"its work uses port z, which it does not have"});
  CHECK(mistakes([](StageSpec& spec) {
          spec.work[0] = HostWork{.uses = {{"z", read}}};
        }) == Lines{"its work uses port z, which it does not have"});
  CHECK(mistakes([](StageSpec& spec) {
          spec.work[0] = Draw{.name = "d", .vertex = "v", .fragment = "f", .colors = {"c"}, .depth = "z"};
        }) == Lines{"its work uses port c, which it does not have", "its work uses port z, which it does not have"});
  CHECK(mistakes([](StageSpec& spec) { spec.work[0] = Dispatch{.kernel = "k", .over = "", .indirect = "z"}; }) ==
        Lines{"its work uses port z, which it does not have"});
}

TEST_CASE("a kernel runs over a domain or over groups from a port, not both") {
  CHECK(mistakes([](StageSpec& spec) { spec.work[0] = Dispatch{.kernel = "k", .over = ""}; }) ==
        Lines{"kernel k: needs either a domain or an indirect port"});
  CHECK(mistakes([](StageSpec& spec) { spec.work[0] = Dispatch{.kernel = "k", .over = "points", .indirect = "counts"}; }) ==
        Lines{"kernel k: needs either a domain or an indirect port"});
}

TEST_CASE("elements that OpenGL cannot have in a port's way are told") {
  const auto with = [](ElementType type, Usage usage, const std::string& domain) {
    return mistakes([&](StageSpec& spec) { spec.ports.push_back(port("z", read, domain, type, usage)); });
  };
  CHECK(with(ElementType::float1, Usage::uniform, "1") == Lines{});
  CHECK(with(ElementType::mat3, Usage::uniform, "4") == Lines{});
  CHECK(with(ElementType::float1, Usage::uniform, "4") ==
        Lines{"port z: float cannot be an array with usage uniform, whose elements fill 16 bytes"});
  CHECK(with(ElementType::rgba8, Usage::storage, "cells") == Lines{"port z: rgba8 is only in textures"});
  CHECK(with(ElementType::rgba8, Usage::image, "cells") == Lines{});
  CHECK(with(ElementType::depth, Usage::image, "cells") == Lines{"port z: depth cannot be an image"});
  CHECK(with(ElementType::depth, Usage::framebuffer, "cells") == Lines{});
  CHECK(with(ElementType::mat3, Usage::image, "cells") == Lines{"port z: mat3 cannot be an image"});
  CHECK(with(ElementType::int1, Usage::framebuffer, "cells") == Lines{"port z: int cannot be drawn to"});
  CHECK(mistakes([](StageSpec& spec) {
          spec.ports.push_back(port("z", read, "cells", ElementType::mat3));
          spec.work.emplace_back(HostWork{.uses = {{"z", read, Usage::image}}});
        }) == Lines{"port z: mat3 cannot be an image"});
}

TEST_CASE("a condition that never holds is told") {
  CHECK(mistakes([](StageSpec& spec) {
          spec.ports[0].when = {"kernel", "cubik"};
        }) == Lines{"condition kernel = cubik: never holds"});
  CHECK(mistakes([](StageSpec& spec) {
          spec.work[0] = Dispatch{.kernel = "k", .over = "points", .when = {"kernel", ""}};
        }) == Lines{"condition kernel = : never holds"});
  CHECK(mistakes([](StageSpec& spec) { spec.ports[0].when = {"time_step", "auto"}; }) == Lines{});
}

TEST_CASE("every fault has words for it") {
  for (int kind = 0; kind < fault_kinds; ++kind) CHECK(describe(static_cast<Fault>(kind)).starts_with("a "));
}

}  // namespace
}  // namespace firn::test
