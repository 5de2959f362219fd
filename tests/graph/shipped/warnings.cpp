#include "tests/catch.h"
#include "tests/graph/shipped/shipped.h"

namespace firn::test {
namespace {

std::string warnings_of(const Shipped& shipped) {
  config::Diagnostics diagnostics;
  static_cast<void>(shipped.plan(shipped.pipeline, {}, diagnostics));
  std::string text;
  for (const config::Diagnostic& one : diagnostics.all()) text += to_string(one) + "\n";
  return text;
}

TEST_CASE("shipped pipelines bring no warnings") {
  for (const std::string& name : shipped_pipelines()) {
    CAPTURE(name);
    CHECK(warnings_of(Shipped(name)) == "");
  }
}

TEST_CASE("height-field pipelines that work on all cells bring no warnings") {
  for (const char* name : {"heightfield_contour.yaml", "heightfield_distance.yaml"}) {
    CAPTURE(name);
    CHECK(warnings_of(Shipped(name, {"cells=all"})) == "");
  }
}

}  // namespace
}  // namespace firn::test
