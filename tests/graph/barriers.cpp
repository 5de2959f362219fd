#include "graph/barriers.h"

#include <string>
#include <utility>
#include <vector>

#include "tests/catch.h"
#include "tests/graph/executions.h"
#include "tests/graph/plans.h"

namespace firn::test {
namespace {

// The plan with barriers as text; every plan of these tests is held against the model as well.
std::string barriers_of(const std::string& text) {
  graph::Plan plan = placed(text);
  INFO(text_of(plan));
  CHECK(fault_of(plan, 5, 1).empty());
  return text_of(plan);
}

std::vector<std::string> reasons_of(const std::string& text) {
  graph::Plan plan = placed(text);
  std::vector<std::string> reasons;
  for (const graph::Barrier* barrier : collect_barriers(plan))
    reasons.push_back(fmt::format("[{}] {}", fmt::join(graph::bit_names(barrier->bits), " "), fmt::join(barrier->reasons, "; ")));
  return reasons;
}

TEST_CASE("each usage of a buffer waits at its own bit") {
  const std::vector<std::pair<std::string, std::string>> bits{
      {"storage", "shader_storage"}, {"uniform", "uniform"},        {"sampled", "texture_fetch"}, {"vertex", "vertex_attrib_array"},
      {"indirect", "command"},       {"transfer", "buffer_update"}, {"host", "buffer_update"}};
  for (const auto& [usage, bit] : bits) {
    CAPTURE(usage);
    CHECK(barriers_of("setup a x:write; b x:read:" + usage) == "setup a [" + bit + "] b");
  }
}

TEST_CASE("each usage of a texture waits at its own bit") {
  const std::vector<std::pair<std::string, std::string>> bits{{"image", "shader_image_access"},
                                                              {"sampled", "texture_fetch"},
                                                              {"transfer", "texture_update"},
                                                              {"host", "texture_update"},
                                                              {"framebuffer", "framebuffer"}};
  for (const auto& [usage, bit] : bits) {
    CAPTURE(usage);
    CHECK(barriers_of("setup a image:write:image; b image:read:" + usage) == "setup a [" + bit + "] b");
  }
}

TEST_CASE("writes by the API and by draws need no barrier before reads") {
  CHECK(barriers_of("setup a x:write:host; b x:read; c x:read:uniform; d x:read:host") == "setup a b c d");
  CHECK(barriers_of("setup a image:write:framebuffer; b image:read:sampled; c image:read:host") == "setup a b c");
}

TEST_CASE("the host waits for shader writes, shader writes do not wait for the host") {
  CHECK(barriers_of("setup a x:write; b x:write:host") == "setup a [buffer_update] b");
  CHECK(barriers_of("setup a x:write; b x:read_write:host") == "setup a [buffer_update] b");
  CHECK(barriers_of("setup a x:read:host; b x:write") == "setup a b");
  CHECK(barriers_of("setup a x:write:host; b x:write") == "setup a b");
}

TEST_CASE("a write waits for earlier reads of any kind") {
  for (const std::string usage : {"storage", "uniform", "sampled", "vertex", "indirect"}) {
    CAPTURE(usage);
    CHECK(barriers_of("setup a x:read:" + usage + "; b x:write") == "setup a [shader_storage] b");
    CHECK(barriers_of("setup a x:read:" + usage + "; b x:accumulate") == "setup a [shader_storage] b");
  }
  for (const std::string usage : {"image", "sampled", "framebuffer"}) {
    CAPTURE(usage);
    CHECK(barriers_of("setup a image:read:" + usage + "; b image:write:image") == "setup a [shader_image_access] b");
  }
  CHECK(barriers_of("setup a x:read; b x:read; c x:read:uniform") == "setup a b c");
}

TEST_CASE("a write waits for earlier writes") {
  CHECK(barriers_of("setup a x:write; b x:write; c x:read_write") == "setup a [shader_storage] b [shader_storage] c");
  CHECK(barriers_of("setup a image:write:framebuffer; b image:write:image") == "setup a [shader_image_access] b");
  CHECK(barriers_of("setup a image:write:image; b image:write:framebuffer") == "setup a [framebuffer] b");
}

TEST_CASE("accumulations wait for everything but each other") {
  CHECK(barriers_of("setup clear g:write; a g:accumulate; b g:accumulate; c g:accumulate; use g:read") ==
        "setup clear [shader_storage] a b c [shader_storage] use");
  CHECK(barriers_of("setup a g:accumulate; clear g:write; b g:accumulate") == "setup a [shader_storage] clear [shader_storage] b");
  CHECK(barriers_of("setup a g:accumulate; b g:read_write; c g:accumulate") == "setup a [shader_storage] b [shader_storage] c");
  CHECK(barriers_of("step a g:accumulate; b g:accumulate") == "step a b");
}

TEST_CASE("one barrier serves every buffer") {
  CHECK(barriers_of("setup a x:write y:write; b x:read; c y:read") == "setup a [shader_storage] b c");
  CHECK(barriers_of("setup a x:write; b y:write; c x:read y:read; d y:read x:read") == "setup a b [shader_storage] c d");
  CHECK(barriers_of("setup a x:read; b y:write; c x:write; d y:read") == "setup a b [shader_storage] c d");
}

TEST_CASE("one barrier carries all bits of a command, and nothing else") {
  CHECK(barriers_of("setup a x:write y:write z:write; b x:read y:read:uniform; c z:read:vertex") ==
        "setup a [uniform shader_storage] b [vertex_attrib_array] c");
}

TEST_CASE("a bit serves only its own kind of access") {
  CHECK(barriers_of("setup a x:write; b x:read:uniform; c x:read; d x:read:uniform") == "setup a [uniform] b [shader_storage] c d");
}

TEST_CASE("a plan without shader writes has no barriers") {
  CHECK(barriers_of("setup a x:write:host step b x:read; c x:read:uniform frame d x:read:vertex image:write:framebuffer") ==
        "setup a step b c frame d");
  CHECK(barriers_of("").empty());
}

TEST_CASE("hazards from one step to the next are found, and the first step is no reason for more") {
  CHECK(barriers_of("step use x:read; make x:write") == "step [shader_storage] use [shader_storage] make");
  CHECK(barriers_of("step make x:write; use x:read:uniform") == "step [shader_storage] make [uniform] use");
  CHECK(barriers_of("step a x:read; b y:write; c y:read; d x:write") == "step [shader_storage] a b [shader_storage] c d");
}

TEST_CASE("what only the first step needs stands at the end of the setup") {
  CHECK(barriers_of("setup init x:write step use x:read") == "setup init [shader_storage] step use");
  CHECK(barriers_of("setup init x:write step use x:read:uniform frame draw x:read:vertex") ==
        "setup init [vertex_attrib_array uniform] step use frame draw");
  CHECK(barriers_of("setup init x:write step move x:read_write") == "setup init step [shader_storage] move");
}

TEST_CASE("a frame waits for steps, and what a step needs after a frame stands at the frame's end") {
  CHECK(barriers_of("step move x:read_write frame draw x:read:vertex image:write:framebuffer") ==
        "step [shader_storage] move frame [vertex_attrib_array] draw");
  CHECK(barriers_of("step use x:read:uniform frame make x:write") == "step use frame [shader_storage] make [uniform]");
  CHECK(barriers_of("step make x:write:host frame tone image:read_write:image") == "step make frame [shader_image_access] tone");
}

TEST_CASE("a barrier that another one makes superfluous is not there") {
  // What the step needs after the frame serves the next frame as well.
  CHECK(barriers_of("step use z:read frame a x:read; b x:write z:write") == "step use frame a [shader_storage] b [shader_storage]");
}

TEST_CASE("a repeat waits for itself only where it can have a second turn") {
  CHECK(barriers_of("setup repeat 4 { a x:read_write }") == "setup repeat 4 { [shader_storage] a }");
  CHECK(barriers_of("setup repeat 1 { a x:read_write }") == "setup repeat 1 { a }");
  CHECK(barriers_of("setup repeat 3 { a x:accumulate }") == "setup repeat 3 { a }");
}

TEST_CASE("what only the first turn needs stands before the repeat") {
  CHECK(barriers_of("setup init x:write; repeat 4 { use x:read }") == "setup init [shader_storage] repeat 4 { use }");
  CHECK(barriers_of("setup init x:write; repeat 4 { use x:read:uniform; move y:read_write }; after y:read") ==
        "setup init [uniform] repeat 4 { use [shader_storage] move } [shader_storage] after");
  CHECK(barriers_of("setup init x:write; repeat 4 { move x:read_write }") == "setup init repeat 4 { [shader_storage] move }");
}

TEST_CASE("what the last turn leaves open is closed after the repeat") {
  CHECK(barriers_of("setup repeat 4 { move x:read_write }; use x:read:uniform") ==
        "setup repeat 4 { [shader_storage] move } [uniform] use");
  CHECK(barriers_of("step repeat 2 { a x:write } frame draw x:read:vertex") ==
        "step repeat 2 { [shader_storage] a } frame [vertex_attrib_array] draw");
}

TEST_CASE("the value that ends a repeat is read by the host after each turn") {
  CHECK(barriers_of("setup repeat 9 until r { solve r:write }") ==
        "setup repeat 9 until r { [shader_storage] solve [buffer_update] }");
  CHECK(barriers_of("setup init r:write; repeat 9 until r { look x:read }") ==
        "setup init [buffer_update] repeat 9 until r { look }");
}

TEST_CASE("nested repeats") {
  CHECK(barriers_of("setup init x:write; repeat 3 { a y:write; repeat 5 { b x:read_write }; c x:read:uniform }") ==
        "setup init repeat 3 { a repeat 5 { [shader_storage] b } [uniform] c }");
  CHECK(barriers_of("step repeat 3 { repeat 5 { b x:accumulate }; c x:read:uniform }") ==
        "step repeat 3 { [shader_storage] repeat 5 { b } [uniform] c }");
}

TEST_CASE("a barrier says which buffer, who touched it before, and who waits") {
  CHECK(reasons_of("setup clear mass:write; scatter mass:accumulate; gather mass:read; again mass:write") ==
        std::vector<std::string>{"[shader_storage] mass: written by clear, accumulated by scatter",
                                 "[shader_storage] mass: accumulated by scatter, read by gather",
                                 "[shader_storage] mass: read by gather, written by again"});
  CHECK(reasons_of("setup a x:write y:write; b x:read y:read:uniform") ==
        std::vector<std::string>{"[uniform shader_storage] x: written by a, read by b; y: written by a, read by b"});
  CHECK(reasons_of("setup a x:write y:write; b x:read; c y:read") ==
        std::vector<std::string>{"[shader_storage] x: written by a, read by b; y: written by a, read by c"});
  CHECK(reasons_of("setup draw image:write:framebuffer; tone image:write:image") ==
        std::vector<std::string>{"[shader_image_access] image: written by draw, written by tone"});
}

TEST_CASE("the reasons of a step's barriers name the stage of the step before") {
  CHECK(reasons_of("step use x:read; make x:write") ==
        std::vector<std::string>{"[shader_storage] x: written by make, read by use",
                                 "[shader_storage] x: read by use, written by make"});
  CHECK(reasons_of("setup init x:write step use x:read:uniform") ==
        std::vector<std::string>{"[uniform] x: written by init, read by use"});
  CHECK(reasons_of("setup solve r:write; repeat 9 until r { look x:read }") ==
        std::vector<std::string>{"[buffer_update] r: written by solve, read by the end of the repeat"});
}

TEST_CASE("bits have names") {
  CHECK(graph::bit_names(0).empty());
  CHECK(graph::bit_names(graph::bit_element_array | graph::bit_pixel_buffer | graph::bit_shader_storage) ==
        std::vector<std::string>{"element_array", "pixel_buffer", "shader_storage"});
}

}  // namespace
}  // namespace firn::test
