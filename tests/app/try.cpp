#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "scene/npy.h"
#include "tests/app/inputs.h"
#include "tests/catch.h"

using firn::scene::NpyArray;
using firn::scene::NpyShape;
using firn::scene::read_npy;
using firn::test::Folder;
using firn::test::Outcome;
using firn::test::run_firn;
using firn::test::Words;

namespace {

template <typename T>
std::string save(const Folder& folder, const std::string& name, const NpyShape& shape, const std::vector<T>& values) {
  std::string file = folder / (name + ".npy");
  firn::scene::write_npy(file, shape, std::span<const T>(values));
  return file;
}

constexpr std::size_t rows = 20, columns = 30;

bool under(std::size_t row, std::size_t column) { return row >= 8 && row < 12 && column >= 10 && column < 14; }

// One body reaches 0.3 m into 4 x 4 of 20 x 30 cells and moves along +x.
Words field_words(const Folder& folder, const std::string& stage) {
  std::vector<float> overlap(rows * columns);
  std::vector<std::int32_t> owner(rows * columns, -1);
  for (std::size_t i = 0; i < overlap.size(); ++i)
    if (under(i / columns, i % columns)) {
      overlap[i] = 0.3F;
      owner[i] = 0;
    }
  return {"try",  stage,
          "--in", "overlap=" + save(folder, "overlap", {rows, columns}, overlap),
          "--in", "owner=" + save(folder, "owner", {rows, columns}, owner),
          "--in", "body_velocity=" + save<float>(folder, "velocity", {1, 3}, {1, 0, 0})};
}

Outcome succeed(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  Outcome outcome = run_firn(words);
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  return outcome;
}

}  // namespace

TEST_CASE("try runs one stage on arrays whose rows lie along z and whose columns lie along x", "[app]") {
  const Folder folder;
  const std::string weight_file = folder / "weight.npy", owner_file = folder / "contour_owner.npy";
  succeed(field_words(folder, "heightfield.contour"),
          {"--out", "contour_weight=" + weight_file, "--out", "contour_owner=" + owner_file});
  const NpyArray weight = read_npy(weight_file), owner = read_npy(owner_file);
  REQUIRE(weight.shape == NpyShape{rows, columns});
  CHECK(weight.kind == firn::scene::NpyKind::float32);
  CHECK(owner.kind == firn::scene::NpyKind::int32);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      CAPTURE(row, column);
      const bool ring = row >= 7 && row < 13 && column >= 9 && column < 15 && !under(row, column);
      CHECK(owner.values[row * columns + column] == (ring ? 0 : -1));
      if (!ring) CHECK(weight.values[row * columns + column] == 0);
    }
  // Straight ahead the direction factor is 1, behind it is 0.
  CHECK(weight.values[10 * columns + 14] == Approx(1));
  CHECK(weight.values[10 * columns + 9] == Approx(0).margin(1e-6));
}

TEST_CASE("try runs stages of several kernels, once or again and again", "[app]") {
  const Folder folder;
  const auto distance = [&](const Words& more) {
    const std::string file = folder / "distance.npy";
    Words words{"--out", "distance=" + file};
    words.insert(words.end(), more.begin(), more.end());
    succeed(field_words(folder, "heightfield.distance_transform"), words);
    return read_npy(file).values;
  };
  const std::vector<double> once = distance({});
  // The column behind the front edge is one step from the way out, those deeper in cost more.
  CHECK(once[10 * columns + 13] > 0);
  CHECK(once[10 * columns + 11] > once[10 * columns + 13]);
  CHECK(once[0] == 0);
  CHECK(distance({"--repeat", "3"}) == once);
  // Each turn goes on from the last: all of the overlap is pressed in the first, none is left for a lower depth.
  const std::string depth = save(folder, "depth", {rows, columns}, std::vector<double>(rows * columns, 2.0));
  const auto lowest = [&](const std::string& repeat) {
    const std::string out = folder / "out.npy";
    succeed({"try", "heightfield.compress", "--in", "overlap=" + (folder / "overlap.npy"), "--in", "depth=" + depth},
            {"--out", "depth=" + out, "--repeat", repeat});
    return std::ranges::min(read_npy(out).values);
  };
  CHECK(lowest("1") == Approx(1.7));
  CHECK(lowest("3") == Approx(1.1));
}

TEST_CASE("try sorts particles on a grid whose size the command line tells", "[app]") {
  const Folder folder;
  const auto seed = firn::test::seed();
  INFO("seed " << seed);
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  std::vector<float> position(300);
  for (float& x : position) x = std::uniform_real_distribution<float>(0.11F, 0.79F)(random);
  const std::string out = folder / "order.npy";
  succeed({"try", "mpm.sort", "--in", "position=" + save(folder, "position", {100, 3}, position)},
          {"--size", "nodes=[11, 12, 13]", "--constant", "grid_cell=0.1", "--out", "order=" + out});
  const std::vector<double> order = read_npy(out).values;
  REQUIRE(order.size() == 100);
  const auto cell = [&](double particle) {
    const float* p = &position[3 * static_cast<std::size_t>(particle)];
    const auto at = [](float x) { return static_cast<int>(std::floor(x / 0.1F)); };
    return std::pair{at(p[0]) + 13 * (at(p[1]) + 12 * at(p[2])), particle};
  };
  for (std::size_t i = 1; i < order.size(); ++i) CHECK(cell(order[i - 1]) < cell(order[i]));
}

TEST_CASE("try binds optional ports that are given or asked for, and constants from the command line", "[app]") {
  const Folder folder;
  const std::string depth = save(folder, "depth", {rows, columns}, std::vector<double>(rows * columns, 0.5));
  const std::string density = save(folder, "density", {rows, columns}, std::vector<float>(rows * columns, 200));
  const std::string out = folder / "mass.npy";
  const auto mass = [&](const Words& more) {
    Words words{"--in", "depth=" + depth, "--in", "density=" + density, "--out", "displaced_mass=" + out};
    words.insert(words.end(), more.begin(), more.end());
    succeed(field_words(folder, "heightfield.resistance"), words);
    return read_npy(out).values.at(0);
  };
  CHECK(mass({}) == Approx(16 * 0.3 * 200));  // cells of 1 m
  CHECK(mass({"--constant", "field_cell=0.5"}) == Approx(16 * 0.3 * 200 / 4));
}

TEST_CASE("try tells on stderr what it took for what was not given, and sums up every output", "[app]") {
  const Folder folder;
  const std::string depth = save(folder, "depth", {2, 3}, std::vector<float>(6, 0.5F));
  const Words words{"try", "pipelines/examples/melt.comp", "--in", "depth=" + depth};
  const Outcome plain = succeed(words, {"--dt", "86400", "--set", "factor=1", "--set", "lapse=0"});
  CHECK(plain.err.find("density not given: 100") != std::string::npos);
  CHECK(plain.err.find("not given, so 0: ground") != std::string::npos);
  CHECK(plain.err.find("--dt") == std::string::npos);
  CHECK(succeed(words, {}).err.find("no --dt") != std::string::npos);
  CHECK(succeed(words, {"-q"}).err.empty());
  // 5 kg/m2 of 100 kg/m3 melt in a day.
  const Outcome json = succeed(words, {"--dt", "86400", "--set", "factor=1", "--set", "lapse=0", "--json"});
  const nlohmann::json outputs = nlohmann::json::parse(json.out);
  REQUIRE(outputs.size() == 1);
  CHECK(outputs[0].at("port") == "depth");
  CHECK(outputs[0].at("min").get<double>() == Approx(0.45));
  CHECK(outputs[0].at("sum").get<double>() == Approx(2.7));
  CHECK(outputs[0].at("nan") == 0);
  CHECK(plain.out.find("0.45") != std::string::npos);
  const std::string broken = save(folder, "broken", {2, 3}, std::vector<float>{1, NAN, 1, 1, NAN, 1});
  const Outcome nan =
      succeed({"try", "pipelines/examples/velocity_damping.comp", "--in", "velocity=" + broken, "--dt", "1"}, {"--json"});
  CHECK(nlohmann::json::parse(nan.out)[0].at("nan") == 2);
}

TEST_CASE("try takes constants and sizes from a scene, and arrays before those", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", firn::test::small_scene), out = folder / "position.npy";
  succeed({"try", "mpm.seed", "--scene", scene}, {"--out", "position=" + out});
  const NpyArray position = read_npy(out);
  REQUIRE(position.shape.size() == 2);
  CHECK(position.shape[0] > 100);
  succeed({"try", "mpm.sort", "--scene", scene, "--in", "position=" + out}, {"--out", "cell_start=" + (folder / "start.npy")});
  CHECK(read_npy(folder / "start.npy").shape == NpyShape{21, 19, 17});
  const std::string few = save<float>(folder, "few", {2, 3}, {0.4F, 0.4F, 0.4F, 0.2F, 0.2F, 0.2F});
  succeed({"try", "mpm.sort", "--scene", scene, "--in", "position=" + few}, {"--out", "order=" + (folder / "order.npy")});
  CHECK(read_npy(folder / "order.npy").values == std::vector<double>{1, 0});
  const std::string still = save<float>(folder, "still", {2, 3}, {0, 0, 0, 0, 0, 0});
  const Outcome away = run_firn({"try", "mpm.advect", "--scene", scene, "--in", "position=" + few, "--in", "velocity=" + still,
                                 "--set", "scene.domain.max=[0.3, 0.9, 1.0]"});
  CHECK(away.status == 2);  // the scene's snow then sticks out of its domain
}

TEST_CASE("a fault in a stage that is tried ends with status 4", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", firn::test::small_scene);
  const std::string position = save<float>(folder, "position", {2, 3}, {0.4F, 0.4F, 0.4F, 0.2F, 0.2F, 0.2F}),
                    velocity = save<float>(folder, "velocity", {2, 3}, {0, 0, 0, 1000, 0, 0});
  const Outcome outcome = run_firn({"try", "mpm.advect", "--scene", scene, "--in", "position=" + position, "--in",
                                    "velocity=" + velocity, "--dt", "1", "--out", "position=" + (folder / "after.npy")});
  CHECK(outcome.status == 4);
  CHECK(outcome.err.find("mpm.advect found a particle outside the domain") != std::string::npos);
  CHECK(std::filesystem::exists(folder / "after.npy"));
}

TEST_CASE("everything that is wrong with a try is told at once, with what would be right", "[app]") {
  const Folder folder;
  const Words good = field_words(folder, "heightfield.contour");
  const std::string real = save(folder, "real", {rows, columns}, std::vector<float>(rows * columns, -1)),
                    wide = save(folder, "wide", {rows, columns + 1}, std::vector<float>(rows * (columns + 1))),
                    flat = save(folder, "flat", {6}, std::vector<float>(6));
  const struct {
    Words words;
    Words fragments;
  } table[] = {
      {{"heightfield.contur"}, {"there is no stage 'heightfield.contur'; did you mean 'heightfield.contour'?"}},
      {{"heightfield.contour", "--in", "overlp=" + real, "--in", "owner=" + real, "--out", "owner=a.npy", "--out", "nix=a.npy",
        "--set", "kk=3", "--set", "direction=thesys", "--in", "body_velocity=nowhere.npy"},
       {"--in overlp=" + real + ": error: heightfield.contour has no port 'overlp'; did you mean 'overlap'?",
        "holds float32; owner wants int32 (in NumPy: array.astype(numpy.int32))", "heightfield.contour only reads 'owner'",
        "heightfield.contour has no output 'nix'; valid: contour_weight, contour_owner", "has no parameter 'kk'; did you mean 'k'?",
        "direction cannot be 'thesys'; did you mean 'thesis'?", "nowhere.npy: this file does not exist"}},
      {{"heightfield.contour", "--in", "overlap=" + wide, good[4], good[5], "--in", "body_velocity=" + flat},
       {"says that 'cells' is (20, 30), but ", "has shape (6,); body_velocity wants (bodies, 3)"}},
      {{"heightfield.contour", "--constant", "gravity=3"}, {"heightfield.contour uses no constants"}},
      {{"heightfield.overlap", "--in", "depth=" + real, "--in", "underside"}, {"--in underside: error: expected PORT=FILE.npy"}},
      {{"heightfield.compress", "--in", "overlap=" + real},
       {"heightfield.compress needs --in depth=FILE.npy, shape (rows, columns), float32: depth S of the snow"}},
      {{"heightfield.compress", "--in", "depth=" + real, "--constant", "min_densty=3"},
       {"uses no constant 'min_densty'; did you mean 'min_density'?"}},
      {{"heightfield.compress", "--in", "depth=" + real, "--constant", "min_density=thin"}, {"min_density must be a number"}},
      {{"heightfield.compress", "--in", "depth=" + real, "--out", "depth=nowhere/a.npy"}, {"there is no folder 'nowhere'"}},
      {{"heightfield.compress", "--in", "depth=" + real, "--size", "cels=3"}, {"works on no 'cels'; did you mean 'cells'?"}},
      {{"heightfield.compress", "--in", "depth=" + real, "--size", "cells=3"}, {"the size of 'cells' is rows, columns"}},
      {{"mpm.sort", "--in", "position=" + save(folder, "none", {0, 3}, std::vector<float>{})},
       {"nothing tells the size of 'nodes'; give one of --size nodes=[16, 16, 16], --scene SCENE",
        "needs 'grid_cell' (float, m): distance h of neighbouring nodes; give --constant grid_cell=VALUE or --scene SCENE"}},
      {{"mpm.advect", "--in", "position=" + save(folder, "few", {1, 3}, std::vector<float>(3)), "--in",
        "velocity=" + folder / "few.npy"},
       {"needs 'grid_nodes' (ivec3, 1): nodes per axis; give --constant grid_nodes=[NX, NY, NZ] or --scene SCENE"}},
      {{"mpm.advect", "--in", "position=" + folder / "few.npy", "--constant", "grid_nodes=8"},
       {"grid_nodes must be a list of 3 numbers"}},
      {{"mpm.advect", "--in", "position=" + folder / "few.npy", "--constant", "grid_nodes=[8, 8.5, 8]"},
       {"--constant grid_nodes=[8, 8.5, 8]: error: grid_nodes must be three whole numbers, not [8, 8.5, 8]"}},
      {{"render.shadow_map", "--constant", "sun_direction=1"}, {"sun_direction must be a list of 3 numbers"}},
      {{"mpm.seed"}, {"mpm.seed works on a scene: --scene SCENE"}},
      {{"mpm.seed", "--set", "scene.seed=3"}, {"needs a scene: --scene SCENE"}},
      {{"io.frames"}, {"goes on from the picture 'image', which no array can be"}},
      {{"pipelines/examples/wind_drift.com"}, {"there is no stage"}},
      {{"nowhere.comp"}, {"cannot be read"}},
  };
  for (const auto& bad : table) {
    Words words{"try"};
    words.insert(words.end(), bad.words.begin(), bad.words.end());
    const Outcome outcome = run_firn(words);
    INFO(outcome.err);
    CHECK(outcome.status == 2);
    for (const std::string& fragment : bad.fragments) {
      INFO("expected: " << fragment);
      CHECK(outcome.err.find(fragment) != std::string::npos);
    }
  }
}

TEST_CASE("whatever stage is tried without anything, it runs or says what it needs", "[app]") {
  const nlohmann::json stages = nlohmann::json::parse(run_firn({"list", "--json"}).out);
  for (const nlohmann::json& stage : stages) {
    const std::string name = stage.at("name");
    const Outcome outcome = run_firn({"try", name});
    INFO(name << "\n" << outcome.err);
    CHECK((outcome.status == 0 || outcome.status == 2));
    if (outcome.status == 2) CHECK(outcome.err.find("try " + name + ": error: ") != std::string::npos);
  }
}
