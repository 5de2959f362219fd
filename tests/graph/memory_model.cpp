#include "tests/graph/memory_model.h"

#include <string>

#include "tests/catch.h"
#include "tests/graph/executions.h"
#include "tests/graph/plans.h"

// The model judges the barriers, so it is itself shown plans whose faults are known.

namespace firn::test {
namespace {

std::string verdict(const std::string& text) {
  graph::Plan plan = PlanText(text).plan();
  return fault_of(plan, 5, 1);
}

TEST_CASE("the model asks for the bit of the reader after a shader write") {
  CHECK(verdict("setup a x:write; b x:read:uniform") == "read after write of x: a, then b, without uniform");
  CHECK(verdict("setup a x:write; [shader_storage] b x:read:uniform") == "read after write of x: a, then b, without uniform");
  CHECK(verdict("setup a x:write; [uniform] b x:read:uniform").empty());
  CHECK(verdict("setup a image:write:image; b image:read:host") == "read after write of image: a, then b, without texture_update");
  CHECK(verdict("setup a x:write; b x:read:host") == "read after write of x: a, then b, without buffer_update");
  CHECK(verdict("setup a image:write:image; b image:write:framebuffer") ==
        "read after write of image: a, then b, without framebuffer");
}

TEST_CASE("a barrier serves only what was written before it") {
  CHECK(verdict("setup [uniform] a x:write; b x:read:uniform") == "read after write of x: a, then b, without uniform");
  CHECK(verdict("setup a x:write; [uniform] b x:read:uniform; c y:read y:read").empty());
  CHECK(verdict("setup a x:write; [uniform shader_storage] b x:write; c x:read:uniform") ==
        "read after write of x: b, then c, without uniform");
}

TEST_CASE("a barrier far ahead of the reader serves as well") {
  CHECK(verdict("setup a x:write; [shader_storage] b x:read; c y:write; d x:read").empty());
}

TEST_CASE("the model finds writes that overtake") {
  CHECK(verdict("setup a x:read; b x:write") == "write after read of x: a, then b, without shader_storage");
  CHECK(verdict("setup a x:read:indirect; b x:write") == "write after read of x: a, then b, without shader_storage");
  CHECK(verdict("setup a image:read:sampled; b image:write:image") ==
        "write after read of image: a, then b, without shader_image_access");
  CHECK(verdict("setup a x:write; b x:write") == "write after write of x: a, then b, without shader_storage");
  CHECK(verdict("setup a x:write; b x:accumulate") == "write after write of x: a, then b, without shader_storage");
  CHECK(verdict("setup a x:accumulate; b x:write") == "write after write of x: a, then b, without shader_storage");
  CHECK(verdict("setup a x:accumulate; b x:accumulate").empty());
  CHECK(verdict("setup a x:read:host; b x:write").empty());
  CHECK(verdict("setup a x:write:host; b x:read:uniform; c x:read; d x:read:host").empty());
}

TEST_CASE("the model looks at what follows what in a run") {
  CHECK(verdict("setup a x:write step b x:read") == "read after write of x: a, then b, without shader_storage");
  CHECK(verdict("step a x:read_write") == "write after write of x: a, then a, without shader_storage");
  CHECK(verdict("step a x:write [uniform] frame b x:read:uniform") == "write after write of x: a, then a, without shader_storage");
  CHECK(verdict("frame a x:read_write") == "write after write of x: a, then a, without shader_storage");
  CHECK(verdict("step a x:read:uniform frame [shader_storage] b x:write") == "read after write of x: b, then a, without uniform");
  CHECK(verdict("setup repeat 1 { a x:read_write }").empty());
  CHECK(verdict("setup repeat 2 { a x:read_write }") == "write after write of x: a, then a, without shader_storage");
  CHECK(verdict("setup a x:write; repeat 2 { b x:read; [shader_storage] c y:read }") ==
        "read after write of x: a, then b, without shader_storage");
  CHECK(verdict("setup repeat 2 { a y:read; [shader_storage] b x:write }; c x:read") ==
        "read after write of x: b, then c, without shader_storage");
  CHECK(verdict("setup repeat 2 until r { a x:read; } b r:write; repeat 2 until r { c x:read }") ==
        "read after write of r: b, then until, without buffer_update");
}

TEST_CASE("the model tells barriers and bits that nobody needs") {
  CHECK(verdict("setup a x:read; [shader_storage] b x:read").starts_with("a barrier nobody needs"));
  CHECK(verdict("setup a x:write; [shader_storage] b y:write; [shader_storage] c x:read").starts_with("a barrier nobody needs"));
  CHECK(verdict("setup a x:write; [shader_storage uniform] b x:read").starts_with("a bit nobody needs: uniform"));
}

TEST_CASE("stages that do not run in every step are left out at times") {
  graph::Plan plan = PlanText("step a x:write; b x:read").plan();
  plan.stages[1].every = 2;
  std::size_t without = 0;
  std::size_t steps = 0;
  for (const Trace& events : executions(plan, 5, 1)) {
    for (const Event& event : events) steps += event.stage == 0 ? 1 : 0;
    for (const Event& event : events) without += event.stage == 1 ? 1 : 0;
  }
  CHECK(without < steps);
  CHECK(without > steps / 2);
}

}  // namespace
}  // namespace firn::test
