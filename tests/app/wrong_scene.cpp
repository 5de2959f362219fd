#include <algorithm>

#include "tests/app/inputs.h"
#include "tests/catch.h"

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::run_firn;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a scene of the wrong kind is one error that names what is missing and the scenes that have it", "[app]") {
  const struct {
    std::string pipeline, scene, lacks, would_do, not_named;
  } table[] = {
      {"heightfield_contour", "snowball", "the scene has no 'field'",
       "ball_drag, ball_drag_sand, ball_drop, footprints, plough, stones", "snow_cover"},
      {"heightfield_distance", "two_snowballs", "the scene has no 'field'", "ball_drop", "snow_gun"},
      {"mpm_snow", "ball_drop", "the scene has no 'domain' with 'snow' in it", "snow_gun, snowball", "plough"},
      {"mpm_thesis", "stones", "the scene has no 'domain' with 'snow' in it", "two_snowballs", "footprints"},
  };
  for (const auto& one : table)
    for (const char* verb : {"check", "explain", "profile", "run"}) {
      const Folder folder;
      firn::test::Words words{verb, one.pipeline, "--scene", one.scene};
      if (std::string(verb) == "run") words.insert(words.end(), {"--out", folder / "out"});
      const Outcome outcome = run_firn(words);
      INFO(one.pipeline << " on " << one.scene << "\n" << outcome.err);
      CHECK(outcome.status == 2);
      CHECK(std::ranges::count(outcome.err, '\n') == 1);
      CHECK(contains(outcome.err, one.lacks));
      CHECK(contains(outcome.err, " stages ("));
      CHECK(contains(outcome.err, one.would_do));
      CHECK_FALSE(contains(outcome.err, one.not_named));
    }
}
