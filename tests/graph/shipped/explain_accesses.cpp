#include "graph/explain_accesses.h"

#include "tests/catch.h"
#include "tests/graph/shipped/shipped.h"

using Order = firn::graph::AccessNote::Order;

TEST_CASE("every access of a pipeline that comes with Firn has its explanation, and is in order", "[graph]") {
  for (const std::string& name : firn::test::shipped_pipelines()) {
    CAPTURE(name);
    const firn::test::Shipped shipped(name);
    for (const bool on_device : {false, true}) {
      const firn::graph::Plan plan = shipped.plan({.share_memory = true, .decide_on_device = on_device});
      const firn::graph::PlanNotes notes = firn::graph::explain_accesses(plan);
      int own = 0, earlier = 0, none = 0;
      for (const firn::graph::RunNotes* phase : {&notes.setup, &notes.step, &notes.frame})
        for (const auto& run : *phase)
          for (const firn::graph::AccessNote& note : run) {
            CAPTURE(note.why);
            REQUIRE(note.order != Order::missing);
            CHECK_FALSE(note.why.empty());
            (note.order == Order::own_barrier ? own : note.order == Order::earlier_barrier ? earlier : none) += 1;
          }
      CHECK(own > 0);
      CHECK(earlier > 0);
      CHECK(none > 0);
    }
  }
}
