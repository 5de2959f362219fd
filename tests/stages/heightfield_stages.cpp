// Every height-field stage against its double-precision reference, on random fields under random balls.

#include "tests/stages/random_field.h"

using namespace firn::test;
namespace ref = firn::reference;

namespace {

StageRun stage(const std::string& name, const std::string& options, const firn::graph::Environment& environment, Arrays in) {
  StageRun run;
  run.stage = name;
  run.options = options;
  run.environment = environment;
  run.in = std::move(in);
  return run;
}

Arrays run(const std::string& name, const std::string& options, const RandomField& field, Arrays in) {
  return run_stage(stage(name, options, field.environment(), std::move(in)));
}

std::vector<ref::StepCosts> costs(const RandomField& f, const ref::Direction& direction) {
  std::vector<ref::StepCosts> result;
  for (const Vector3d& v : f.velocity) result.push_back(ref::step_costs(v, direction));
  return result;
}

// Snow on its way out of random cells under the balls, as depth and mass per area.
ref::Amounts random_displaced(RandomField& f) {
  ref::Amounts amounts = ref::Amounts::none(f.overlap);
  for (int z = 0; z < f.field.rows(); ++z)
    for (int x = 0; x < f.field.columns(); ++x)
      if (f.overlap(z, x) > 0) {
        amounts.mass(z, x) = single(f.random.uniform(0, 80));
        amounts.volume(z, x) = single(f.random.uniform(0, 0.4));
      }
  return amounts;
}

const char* rules[] = {"thesis", "appendix"};
ref::Direction direction(const std::string& rule, double k) {
  return {rule == "thesis" ? ref::FactorRule::thesis : ref::FactorRule::appendix, k};
}

// What the graph binds because some stage reads it; alone, a stage has to be told.
std::string with_heights(const std::string& more) {
  return "{bind: {displaced_height: displaced_height, arrived_height: arrived_height}" + (more.empty() ? "" : ", " + more) + "}";
}

}  // namespace

TEST_CASE("overlap is the reference's") {
  INFO("seed " << seed());
  const RandomField f(seed(), 45, 70, 6);
  const Arrays out = run("heightfield.overlap", "{}", f, f.arrays({"ground", "depth", "underside"}));
  REQUIRE(f.overlap.maxCoeff() > 0);
  CHECK(relative_error(out.floats.at("overlap"), flat(f.overlap)) <= 1e-5);
}

TEST_CASE("resistance, its point and the displaced mass are the reference's") {
  INFO("seed " << seed());
  const RandomField f(seed(), 45, 70, 6);
  const auto expected = ref::resistance(f.field, f.overlap, f.underside.owner, f.velocity, 0.5);
  const Arrays out =
      run("heightfield.resistance", "{time_constant: 0.5, bind: {ground: ground, depth: depth, displaced_mass: displaced_mass}}", f,
          f.arrays({"ground", "depth", "density", "overlap", "owner", "body_velocity"}));
  std::vector<float> mass;
  std::vector<Vector3d> point, force;
  for (const ref::Resistance& r : expected) {
    mass.push_back(static_cast<float>(r.mass));
    point.push_back(r.point);
    force.push_back(r.force);
  }
  CHECK(relative_error(out.floats.at("displaced_mass"), mass) <= 1e-5);
  CHECK(relative_error(out.floats.at("contact_point"), flat(point)) <= 1e-5);
  CHECK(relative_error(out.floats.at("resistance"), flat(force)) <= 1e-5);
}

TEST_CASE("compress leaves and pushes away what the reference does, in both models") {
  INFO("seed " << seed());
  const RandomField f(seed(), 45, 70, 6);
  for (const char* model : {"conserving", "thesis"}) {
    CAPTURE(model);
    ref::Field after = f.field;
    const ref::Amounts pushed =
        ref::compress(after, f.overlap,
                      {f.min_density, f.max_density,
                       std::string(model) == "thesis" ? ref::CompressionModel::thesis : ref::CompressionModel::conserving});
    const double area = f.field.h * f.field.h;
    const Arrays out =
        run("heightfield.compress", std::string("{bind: {displaced_height: displaced_height}, model: ") + model + "}", f,
            f.arrays({"depth", "density", "overlap"}));
    CHECK(relative_error(out.floats.at("depth"), flat(after.snow)) <= 1e-5);
    CHECK(relative_error(out.floats.at("density"), flat(after.density)) <= 1e-5);
    CHECK(relative_error(out.floats.at("displaced"), flat(Cells(pushed.mass / area))) <= 1e-5);
    CHECK(relative_error(out.floats.at("displaced_height"), flat(Cells(pushed.volume / area))) <= 1e-5);
  }
}

TEST_CASE("contour and its distribution are the reference's, by both rules") {
  INFO("seed " << seed());
  RandomField f(seed(), 45, 70, 6);
  for (const char* rule : rules) {
    CAPTURE(rule);
    const ref::Contours around = ref::contours(f.overlap, f.underside.owner, f.velocity, direction(rule, 8));
    const Arrays out =
        run("heightfield.contour", std::string("{direction: ") + rule + "}", f, f.arrays({"overlap", "owner", "body_velocity"}));
    CHECK(relative_error(out.floats.at("contour_weight"), flat(around.weight)) <= 1e-5);
    CHECK(out.integers.at("contour_owner") == flat(around.owner));
    const ref::Amounts displaced = random_displaced(f);
    const ref::Amounts arriving =
        ref::distribute_contour(displaced, f.underside.owner, around, static_cast<int>(f.velocity.size()));
    Arrays in = f.arrays({"owner"});
    in.floats["contour_weight"] = flat(around.weight);
    in.integers["contour_owner"] = flat(around.owner);
    in.floats["displaced"] = flat(displaced.mass);
    in.floats["displaced_height"] = flat(displaced.volume);
    const Arrays spread = run("heightfield.distribute_contour", with_heights(""), f, in);
    CHECK(relative_error(spread.floats.at("arrived"), flat(arriving.mass)) <= 1e-5);
    CHECK(relative_error(spread.floats.at("arrived_height"), flat(arriving.volume)) <= 1e-5);
  }
}

TEST_CASE("the distance transform and its distribution are the reference's, by both rules and neighbourhoods") {
  INFO("seed " << seed());
  RandomField f(seed(), 45, 70, 6);
  for (const char* rule : rules) {
    CAPTURE(rule);
    const Cells distance = ref::distance_transform(f.overlap, f.underside.owner, costs(f, direction(rule, 4)));
    const Arrays out = run("heightfield.distance_transform", std::string("{direction: ") + rule + "}", f,
                           f.arrays({"overlap", "owner", "body_velocity"}));
    CHECK(relative_error(out.floats.at("distance"), flat(distance)) <= 1e-5);
    const Cells given = single(distance);
    const ref::Amounts displaced = random_displaced(f);
    for (const int neighbours : {4, 8}) {
      CAPTURE(neighbours);
      const ref::Amounts arriving = ref::distribute_distance(displaced, given, neighbours);
      Arrays in;
      in.floats["distance"] = flat(given);
      in.floats["displaced"] = flat(displaced.mass);
      in.floats["displaced_height"] = flat(displaced.volume);
      const Arrays spread =
          run("heightfield.distribute_distance", with_heights("neighbours: " + std::to_string(neighbours)), f, in);
      CHECK(relative_error(spread.floats.at("arrived"), flat(arriving.mass)) <= 1e-5);
      CHECK(relative_error(spread.floats.at("arrived_height"), flat(arriving.volume)) <= 1e-5);
    }
  }
}

TEST_CASE("distances are the cheapest ones where the way out winds from body to body") {
  INFO("seed " << seed());
  RandomField f(seed(), 45, 70, 6);
  f.velocity = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {1, -1, 0.5}};
  f.overlap.setConstant(0.5);
  f.overlap(20, 30) = 0;  // the only way out
  for (int z = 0; z < f.field.rows(); ++z)
    for (int x = 0; x < f.field.columns(); ++x) f.underside.owner(z, x) = static_cast<int>(f.random.uniform(0, 5.999));
  const std::vector<float> expected = flat(ref::distance_transform(f.overlap, f.underside.owner, costs(f, direction("thesis", 4))));
  const Arrays out = run("heightfield.distance_transform", "{}", f, f.arrays({"overlap", "owner", "body_velocity"}));
  const std::vector<float>& ours = out.floats.at("distance");
  REQUIRE(ours.size() == expected.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    CAPTURE(i);
    if (std::isinf(expected[i]))
      CHECK(std::isinf(ours[i]));
    else
      CHECK(std::abs(ours[i] - expected[i]) <= 1e-5f * expected[i]);
  }
}

TEST_CASE("deposit adds what the reference adds") {
  INFO("seed " << seed());
  RandomField f(seed(), 45, 70, 6);
  ref::Amounts arriving = ref::Amounts::none(f.overlap);
  for (int z = 0; z < f.field.rows(); ++z)
    for (int x = 0; x < f.field.columns(); ++x)
      if (f.random.uniform(0, 1) < 0.3) {
        arriving.mass(z, x) = single(f.random.uniform(0, 60));
        arriving.volume(z, x) = single(arriving.mass(z, x) / f.random.uniform(40, 450));
      }
  const double area = f.field.h * f.field.h;
  ref::Field after = f.field;
  ref::deposit(after, {arriving.mass * area, arriving.volume * area});
  Arrays in = f.arrays({"depth", "density"});
  in.floats["arrived"] = flat(arriving.mass);
  in.floats["arrived_height"] = flat(arriving.volume);
  const Arrays out = run("heightfield.deposit", "{bind: {arrived_height: arrived_height}}", f, in);
  CHECK(relative_error(out.floats.at("depth"), flat(after.snow)) <= 1e-5);
  CHECK(relative_error(out.floats.at("density"), flat(after.density)) <= 1e-5);
}

TEST_CASE("one pass of flatten is the reference's, with both lengths of a diagonal") {
  INFO("seed " << seed());
  const RandomField f(seed(), 45, 70, 6);
  for (const char* diagonal : {"euclidean", "thesis"}) {
    CAPTURE(diagonal);
    const ref::Flattened after =
        ref::flatten(f.field, f.underside.height,
                     {0.5, std::string(diagonal) == "thesis" ? ref::Diagonal::thesis : ref::Diagonal::euclidean, 0.8, 1e-6});
    const Arrays out = run("heightfield.flatten", std::string("{slope: 0.5, relaxation: 0.8, diagonal: ") + diagonal + "}", f,
                           f.arrays({"ground", "depth", "density", "underside"}));
    CHECK(relative_error(out.floats.at("depth"), flat(after.field.snow)) <= 1e-5);
    CHECK(relative_error(out.floats.at("density"), flat(after.field.density)) <= 1e-5);
    CHECK(out.floats.at("moved").at(0) == Approx(after.given.maxCoeff()).epsilon(1e-5));
  }
}
