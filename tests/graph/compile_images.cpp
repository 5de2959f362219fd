#include <string>

#include "tests/catch.h"
#include "tests/graph/made_up.h"

// Images: which buffers become textures.

namespace firn::test {
namespace {

using graph::ElementType;
using graph::Usage;
using enum graph::Access;

graph::Registry registry_with_images() {
  graph::Registry registry = made_up_registry();
  registry.add(stage("demo.paint", {port("picture", write, "cells", ElementType::vec4, Usage::image)}));
  registry.add(stage("demo.sample", {port("picture", read, "cells", ElementType::vec4, Usage::sampled)}));
  registry.add(stage("demo.bytes", {port("small", write, "cells", ElementType::rgba8, Usage::image)}));
  registry.add(stage("demo.store", {port("picture", write, "cells", ElementType::vec4)}));
  registry.add(stage("demo.flat", {port("line", write, "points", ElementType::vec4, Usage::image)}));
  registry.add(stage("demo.wide", {port("wide", write, "cells*2", ElementType::vec4, Usage::image)}));
  registry.add(stage("demo.early", {port("line", read, "points", ElementType::vec4, Usage::sampled)}));
  return registry;
}

TEST_CASE("a buffer that is stored to as an image is a texture of its domain's size") {
  const auto [plan, lines] = compiled("firn: 1\nstep: [demo.sample, demo.paint]\n", {}, registry_with_images());
  CHECK(lines ==
        Lines{"p.yaml:2:8: warning: demo.sample reads 'picture' before any stage has written it: at first it reads zeros"});
  REQUIRE(plan.buffers.size() == 1);
  CHECK(plan.buffers[0].texture);
  CHECK((plan.buffers[0].width == 3 && plan.buffers[0].height == 2));
  CHECK(compiled("firn: 1\nstep: [demo.bytes]\n", {}, registry_with_images()).plan.buffers[0].texture);
  CHECK_FALSE(compiled("firn: 1\nstep: [demo.store, demo.sample]\n", {}, registry_with_images()).plan.buffers[0].texture);
}

TEST_CASE("an image needs a domain with two dimensions, whichever port names it first") {
  const std::string text = ": port 'line' is an image, but its domain 'points' is not two-dimensional";
  CHECK(compiled("firn: 1\nstep: [demo.flat]\nframe: [demo.early]\n", {}, registry_with_images()).messages ==
        Lines{"p.yaml:2:8: error: demo.flat" + text});
  CHECK(compiled("firn: 1\nstep: [demo.early]\nframe: [demo.flat]\n", {}, registry_with_images()).messages.front() ==
        "p.yaml:3:9: error: demo.flat" + text);
  CHECK(compiled("firn: 1\nstep: [demo.wide]\n", {}, registry_with_images()).messages.front() ==
        "p.yaml:2:8: error: demo.wide: port 'wide' is an image, but its domain 'cells*2' is not two-dimensional");
}

TEST_CASE("an image is not a storage block as well") {
  CHECK(compiled("firn: 1\nstep: [demo.store, demo.paint]\nframe: [demo.sample]\n", {}, registry_with_images()).messages ==
        Lines{"p.yaml:2:8: error: demo.store uses 'picture' as storage, but it is an image; bind the port to a buffer of its own"});
}

}  // namespace
}  // namespace firn::test
