#include "config/nearest.h"

#include <string>
#include <vector>

#include "tests/catch.h"

using firn::config::nearest;
using firn::config::suggestion;

namespace {

const std::vector<std::string> stages = {"mpm.clear_grid",        "mpm.particles_to_grid",          "mpm.grid_velocities",
                                         "mpm.grid_to_particles", "heightfield.distance_transform", "heightfield.contour"};

}  // namespace

TEST_CASE("the nearest stage name is the one that was meant") {
  CHECK(nearest("mpm.particle_to_grid", stages) == "mpm.particles_to_grid");
  CHECK(nearest("mpm.grid_to_particle", stages) == "mpm.grid_to_particles");
  CHECK(nearest("mpm.clear-grid", stages) == "mpm.clear_grid");
  CHECK(nearest("heightfield.countour", stages) == "heightfield.contour");
  CHECK(nearest("heightfield.distance_transfrom", stages) == "heightfield.distance_transform");
  CHECK(nearest("particles_to_grid", stages) == "mpm.particles_to_grid");
}

TEST_CASE("insertions, deletions, replacements and swaps of neighbours are one edit each") {
  const std::vector<std::string> choices = {"pressure", "density"};
  CHECK(nearest("densiity", choices) == "density");
  CHECK(nearest("densty", choices) == "density");
  CHECK(nearest("dansity", choices) == "density");
  CHECK(nearest("denstiy", choices) == "density");
  // In a word of two letters one edit is allowed, and a swap is one.
  CHECK(nearest("td", {"dt"}) == "dt");
  CHECK_FALSE(nearest("xy", {"dt"}).has_value());
}

TEST_CASE("upper and lower case are alike") { CHECK(nearest("DENSITY", {"density"}) == "density"); }

TEST_CASE("a name that resembles none has no nearest") {
  CHECK_FALSE(nearest("viscosity", stages).has_value());
  CHECK_FALSE(nearest("a", {"b"}).has_value());
  CHECK_FALSE(nearest("", {"b"}).has_value());
  CHECK_FALSE(nearest("density", {}).has_value());
}

TEST_CASE("the nearer of two wins, and the first of two that are equally near") {
  CHECK(nearest("friction", {"fraction", "frictions", "friction_"}) == "fraction");
  CHECK(nearest("frictoin", {"fractions", "friction"}) == "friction");
}

TEST_CASE("a suggestion names the nearest, else the valid names") {
  CHECK(suggestion("densty", {"density", "young"}) == "; did you mean 'density'?");
  CHECK(suggestion("colour", {"density", "young"}) == "; valid: density, young");
  CHECK(suggestion("colour", {}).empty());
}

TEST_CASE("a suggestion lists at most 12 names") {
  std::vector<std::string> names;
  for (char c = 'a'; c <= 'l'; ++c) names.push_back(std::string(6, c));
  CHECK(suggestion("?", names).find("more") == std::string::npos);
  CHECK(suggestion("?", names).find("llllll") != std::string::npos);
  names.emplace_back("mmmmmm");
  names.emplace_back("nnnnnn");
  CHECK(suggestion("?", names).find("llllll and 2 more") != std::string::npos);
  CHECK(suggestion("?", names).find("mmmmmm") == std::string::npos);
}

TEST_CASE("a name among thousands costs little, and the first of them are still found") {
  std::vector<std::string> many(50'000, "something_else_altogether");
  many[200] = "density";
  for (int i = 0; i < 2000; ++i) CHECK(nearest("densty", many) == "density");
}
