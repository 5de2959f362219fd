#include "graph/explain_accesses.h"

#include "tests/catch.h"
#include "tests/graph/plans.h"

using firn::graph::AccessNote;
using firn::graph::explain_accesses;
using firn::graph::Plan;
using firn::graph::PlanNotes;
using firn::test::placed;
using Order = firn::graph::AccessNote::Order;

namespace {

void check(const AccessNote& note, Order order, const std::string& why) {
  CAPTURE(note.why, why);
  CHECK(note.order == order);
  CHECK(note.why == why);
}

}  // namespace

TEST_CASE("an access is explained by its own barrier, by an earlier one, or by needing none", "[graph]") {
  const PlanNotes notes = explain_accesses(placed("setup a x:write y:write; b x:read; c y:read x:read; d z:write"));
  REQUIRE(notes.setup.size() == 4);
  check(notes.setup[0][0], Order::none_needed, "nothing on the device has touched it before");
  check(notes.setup[1][0], Order::own_barrier, "written by a");
  check(notes.setup[2][0], Order::earlier_barrier, "written by a, waited for before b");
  check(notes.setup[2][1], Order::earlier_barrier, "written by a, waited for before b");
  check(notes.setup[3][0], Order::none_needed, "nothing on the device has touched it before");
}

TEST_CASE("what the host wrote, what nobody wrote and what several add to needs no barrier", "[graph]") {
  const PlanNotes notes = explain_accesses(
      placed("setup seed x:write:host; use x:read; look w:read; one s:accumulate; other s:accumulate; sum s:read"));
  check(notes.setup[1][0], Order::none_needed, "written by seed, which OpenGL orders by itself");
  check(notes.setup[2][0], Order::none_needed, "nothing on the device has touched it before");
  check(notes.setup[4][0], Order::none_needed, "one added to it as well: sums may come in any order");
  check(notes.setup[5][0], Order::own_barrier, "accumulated by other");
}

TEST_CASE("a write waits for the reads before it", "[graph]") {
  const PlanNotes notes = explain_accesses(placed("setup a x:read; b x:write"));
  check(notes.setup[1][0], Order::own_barrier, "read by a");
}

TEST_CASE("the step is explained as one that follows a step, the frame as one that follows a step", "[graph]") {
  const PlanNotes notes = explain_accesses(placed("setup a x:write:host step b x:read y:write; c x:write frame d x:read:sampled"));
  // In the first step b would read what the host wrote.
  check(notes.step[0][0], Order::own_barrier, "written by c");
  check(notes.step[0][1], Order::earlier_barrier, "written by b, waited for before c");
  check(notes.frame[0][0], Order::own_barrier, "written by c");
}

TEST_CASE("the end of a repeat that the host looks for has a note of its own, and turns are explained as later ones", "[graph]") {
  const PlanNotes notes = explain_accesses(placed("step repeat 4 until r { a r:write x:read; b x:write }"));
  REQUIRE(notes.step.size() == 3);
  check(notes.step[0][1], Order::own_barrier, "written by b");
  CHECK(notes.step[2][0].order != Order::missing);
  CHECK(notes.step[2][0].why.find("written by a") == 0);
}

TEST_CASE("a plan without its barriers is told as not in order", "[graph]") {
  const PlanNotes notes = explain_accesses(firn::test::PlanText("setup a x:write; b x:read; [uniform] c x:read").plan());
  check(notes.setup[1][0], Order::missing, "written by a");
  check(notes.setup[2][0], Order::missing, "written by a");  // a barrier, but not this access's
}

TEST_CASE("buffers that share memory wait for one another", "[graph]") {
  Plan plan = firn::test::PlanText("setup a x:write; b x:read; c y:write").plan();
  plan.buffers[1].storage = plan.buffers[0].storage;
  firn::graph::place_barriers(plan);
  check(explain_accesses(plan).setup[2][0], Order::own_barrier, "its memory held x, read by b");
}
