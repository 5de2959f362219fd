// One wrong thing at a time in a scene that is right otherwise: one error, at its place, saying what would be right.

#include "scene/npy.h"
#include "tests/scene/support.h"

namespace firn::test {

namespace {

const std::string base = R"(firn: 1
name: base
doc: A scene with nothing wrong
seed: 3
time: {dt: 1.0e-4, cfl: 0.3, fps: 25, end: 2.0}
gravity: [0, -9.8, 0]
domain: {min: [0, 0, 0], max: [2, 1.5, 1], cell: 0.05}
materials:
  ball: {preset: packed, density: 410, young: 2.0e5, poisson: 0.25, hardening: 12, critical_compression: 0.02, critical_stretch: 0.006,
         min_density: 90, max_density: 480, slope: 0.7, color: [1, 0.9, 1]}
snow:
  - {sphere: {center: [0.5, 0.7, 0.51], radius: 0.21}, material: ball, velocity: [1, 0, 0], spin: [0, 0, 2], per_cell: 8}
field: {size: [4, 2], cells: [64, 32], origin: [-1, -2], ground: 0.01, depth: 0.4, density: 120, material: new_snow}
bodies:
  - {plane: {point: [0, 0.2, 0], normal: [0, 1, 0]}, friction: 0.31}
  - {sphere: {radius: 0.1}, name: stone, position: [1.5, 0.6, 0.52], mass: 4, color: [0.2, 0.2, 0.21]}
camera: {from: [6, 4, 9], to: [4, 1, 3], fov: 42}
light: {sun: [-0.4, -1, -0.3]}
)";

struct BadScene {
  std::string what;
  std::string old_text, new_text;  // the one change to `base`
  std::string at;                  // the error's place: where this begins in the changed text
  std::string fragment;            // the error must contain it
};

void check_bad(const BadScene& bad, const std::filesystem::path& file = "scene.yaml") {
  INFO(bad.what);
  std::string text = base;
  const std::size_t at = text.find(bad.old_text);
  REQUIRE(at != std::string::npos);
  REQUIRE(text.find(bad.old_text, at + 1) == std::string::npos);
  text.replace(at, bad.old_text.size(), bad.new_text);
  const ReadResult result = read_text(text, file);
  INFO(result.text());
  REQUIRE(result.diagnostics.all().size() == 1);
  const config::Diagnostic& error = result.diagnostics.all().front();
  CHECK(error.severity == config::Severity::error);
  CHECK(error.place.file == file.string());
  const std::array<int, 2> place = place_of(text, bad.at);
  CHECK(error.place.line == place[0]);
  CHECK(error.place.column == place[1]);
  INFO("expected: " << bad.fragment);
  CHECK(error.text.find(bad.fragment) != std::string::npos);
}

const std::string sphere_snow =
    "{sphere: {center: [0.5, 0.7, 0.51], radius: 0.21}, material: ball, velocity: [1, 0, 0], spin: [0, 0, 2], per_cell: 8}";
const std::string stone = "{sphere: {radius: 0.1}, name: stone, position: [1.5, 0.6, 0.52], mass: 4, color: [0.2, 0.2, 0.21]}";

}  // namespace

TEST_CASE("the base of the bad scenes is good") { good_scene(base); }

TEST_CASE("an unknown key is an error with the nearest one") {
  for (const BadScene& bad :
       {BadScene{"root", "gravity:", "gravty:", "gravty:", "gravity"}, BadScene{"time", "fps: 25", "fsp: 25", "fsp: 25", "fps"},
        BadScene{"domain", "cell: 0.05}", "cell: 0.05, edge: 1}", "edge: 1", "edge"},
        BadScene{"material", "young:", "yuong:", "yuong:", "young"},
        BadScene{"snow", "velocity: [1, 0, 0]", "velocty: [1, 0, 0]", "velocty", "velocity"},
        BadScene{"sphere", "radius: 0.21}", "radius: 0.21, centre: 1}", "centre: 1", "center"},
        BadScene{"field", "ground: 0.01", "grund: 0.01", "grund", "ground"},
        BadScene{"body", "friction: 0.31", "fricton: 0.31", "fricton", "friction"},
        BadScene{"plane", "point: [0, 0.2, 0]", "pont: [0, 0.2, 0]", "pont", "point"},
        BadScene{"camera", "fov: 42", "fow: 42", "fow", "fov"},
        BadScene{"light", "light: {sun: [-0.4, -1, -0.3]}", "light: {son: [-0.4, -1, -0.3]}", "son: [", "sun"}})
    check_bad(bad);
}

TEST_CASE("an unknown name is an error with the nearest one") {
  for (const BadScene& bad : {BadScene{"preset", "preset: packed", "preset: paked", "paked", "packed"},
                              BadScene{"material of snow", "material: ball", "material: bal", "bal,", "ball"},
                              BadScene{"preset as material", "material: new_snow", "material: new_snw", "new_snw", "new_snow"}})
    check_bad(bad);
}

TEST_CASE("a value of the wrong type is an error") {
  for (const BadScene& bad :
       {BadScene{"format version", "firn: 1", "firn: one", "one\nname", "firn"},
        BadScene{"seed", "seed: 3", "seed: 3.5", "3.5", "seed"}, BadScene{"dt", "dt: 1.0e-4", "dt: soon", "soon", "auto"},
        BadScene{"gravity", "gravity: [0, -9.8, 0]", "gravity: -9.8", "-9.8", "gravity"},
        BadScene{"gravity not finite", "[0, -9.8, 0]", "[0, -.inf, 0]", "-.inf", "gravity"},
        BadScene{"time no map", "{dt: 1.0e-4, cfl: 0.3, fps: 25, end: 2.0}", "fast", "fast", "time"},
        BadScene{"snow no list", "\n  - " + sphere_snow, " 5", "5\nfield", "list"},
        BadScene{"material no map", "material: ball", "material: [ball]", "[ball]", "material"},
        BadScene{"density", "density: 410", "density: heavy", "heavy", "density"},
        BadScene{"quoted number", "young: 2.0e5", "young: '2.0e5'", "'2.0e5'", "young"},
        BadScene{"center of two", "center: [0.5, 0.7, 0.51]", "center: [0.5, 0.7]", "[0.5, 0.7]", "center"},
        BadScene{"cells of three", "cells: [64, 32]", "cells: [64, 32, 1]", "[64, 32, 1]", "list of 2 numbers"},
        BadScene{"broken cells", "cells: [64, 32]", "cells: [64, 32.5]", "32.5", "cells"},
        BadScene{"depth", "depth: 0.4", "depth: deep", "deep", "metres"},
        BadScene{"orientation", "position: [1.5, 0.6, 0.52]", "orientation: up, position: [1.5, 0.6, 0.52]", "up,", "quaternion"}})
    check_bad(bad);
}

TEST_CASE("a value out of its range is an error") {
  for (const BadScene& bad : {BadScene{"format version", "firn: 1", "firn: 2", "2\nname", "version 2"},
                              BadScene{"seed", "seed: 3", "seed: -3", "-3", "seed"},
                              BadScene{"dt", "dt: 1.0e-4", "dt: 0", "0, cfl", "dt"},
                              BadScene{"cfl 0", "cfl: 0.3", "cfl: 0", "0, fps", "cfl"},
                              BadScene{"cfl above 1", "cfl: 0.3", "cfl: 1.01", "1.01", "cfl"},
                              BadScene{"fps", "fps: 25", "fps: 0", "0, end", "fps"},
                              BadScene{"end", "end: 2.0", "end: -2.0", "-2.0", "end"},
                              BadScene{"cell", "cell: 0.05", "cell: 0", "0}\nmat", "cell"},
                              BadScene{"density 0", "density: 410", "density: 0", "0, young", "density"},
                              BadScene{"density in g", "density: 410", "density: 410000", "410000", "density"},
                              BadScene{"young", "young: 2.0e5", "young: 0", "0, poisson", "young"},
                              BadScene{"poisson 0.5", "poisson: 0.25", "poisson: 0.5", "0.5, hard", "poisson"},
                              BadScene{"poisson below 0", "poisson: 0.25", "poisson: -0.1", "-0.1", "poisson"},
                              BadScene{"hardening", "hardening: 12", "hardening: -1", "-1, crit", "hardening"},
                              BadScene{"compression 0", "critical_compression: 0.02", "critical_compression: 0",
                                       "0, critical_stretch", "critical_compression"},
                              BadScene{"compression 1", "critical_compression: 0.02", "critical_compression: 1",
                                       "1, critical_stretch", "critical_compression"},
                              BadScene{"stretch 0", "critical_stretch: 0.006", "critical_stretch: 0", "0,\n", "critical_stretch"},
                              BadScene{"stretch 1", "critical_stretch: 0.006", "critical_stretch: 1", "1,\n", "critical_stretch"},
                              BadScene{"min above max", "min_density: 90", "min_density: 480", "480, max", "less than max_density"},
                              BadScene{"slope", "slope: 0.7", "slope: -0.7", "-0.7", "slope"},
                              BadScene{"colour", "[1, 0.9, 1]", "[1, 9, 1]", "9, 1]", "color"},
                              BadScene{"per_cell 0", "per_cell: 8", "per_cell: 0", "0}\nfield", "per_cell"},
                              BadScene{"per_cell 65", "per_cell: 8", "per_cell: 65", "65", "per_cell"},
                              BadScene{"radius", "radius: 0.21", "radius: -0.21", "-0.21", "radius"},
                              BadScene{"field size", "size: [4, 2]", "size: [4, 0]", "0], cells", "size"},
                              BadScene{"field cells", "cells: [64, 32]", "cells: [64, 0]", "0], origin", "cells"},
                              BadScene{"depth", "depth: 0.4", "depth: -0.4", "-0.4, density", "depth"},
                              BadScene{"friction", "friction: 0.31", "friction: -0.31", "-0.31", "friction"},
                              BadScene{"mass", "mass: 4", "mass: 0", "0, color", "mass"},
                              BadScene{"fov 1", "fov: 42", "fov: 1", "1}\nlight", "fov"},
                              BadScene{"fov 170", "fov: 42", "fov: 170", "170", "fov"}})
    check_bad(bad);
}

TEST_CASE("a domain that cannot be is an error") {
  for (const BadScene& bad :
       {BadScene{"max below min", "max: [2, 1.5, 1]", "max: [2, -1.5, 1]", "[2, -1.5, 1]", "greater than its min along y"},
        BadScene{"max equals min", "max: [2, 1.5, 1]", "max: [2, 1.5, 0]", "[2, 1.5, 0]", "greater than its min along z"},
        BadScene{"seven cells", "max: [2, 1.5, 1]", "max: [2, 1.5, 0.35]", "[2, 1.5, 0.35]", "at least 8 cells along z"},
        BadScene{"no whole multiple", "max: [2, 1.5, 1]", "max: [2, 1.52, 1]", "[2, 1.52, 1]", "max: [2, 1.5, 1]"},
        BadScene{"absurd", "max: [2, 1.5, 1]", "max: [20000, 1000, 10]", "[20000, 1000, 10]", "GiB"},
        BadScene{"absurd beyond 32 bits on one axis", "max: [2, 1.5, 1]", "max: [2e30, 1.5, 1]", "[2e30, 1.5, 1]", "2^31"}})
    check_bad(bad);
}

TEST_CASE("snow that leaves the domain's margin is an error that names the axis and the distance") {
  // Margin: 2 cells of 0.05 m, so snow must stay between 0.1 and 1.9 along x, 1.4 along y and 0.9 along z.
  const std::string old_text = "sphere: {center: [0.5, 0.7, 0.51], radius: 0.21}";
  const auto snow = [&](const std::string& what, const std::string& shape, const std::string& fragment) {
    return BadScene{what, old_text, shape, "{" + shape.substr(0, 12), fragment};
  };
  for (const BadScene& bad :
       {snow("low x", "sphere: {center: [0.25, 0.7, 0.5], radius: 0.2}", "0.05 m on the low x side"),
        snow("high y", "sphere: {center: [0.5, 1.3, 0.5], radius: 0.2}", "0.1 m on the high y side"),
        snow("box", "box: {center: [0.5, 0.7, 0.5], size: [0.2, 0.2, 0.9]}, orientation: {axis: [0, 1, 0], degrees: 90}",
             "0.05 m on the low x side"),
        snow("capsule", "capsule: {from: [0.5, 0.7, 0.3], to: [0.5, 0.7, 0.8], radius: 0.15}", "0.05 m on the high z side")})
    check_bad(bad);
  std::string touching = base;
  touching.replace(touching.find(old_text), old_text.size(), "sphere: {center: [0.3, 0.7, 0.5], radius: 0.2}");
  good_scene(touching);
}

TEST_CASE("snow that cannot be is an error") {
  const std::string old_text = "sphere: {center: [0.5, 0.7, 0.51], radius: 0.21}";
  for (const BadScene& bad :
       {BadScene{"no shape", old_text + ", ", "", "{material: ball, vel", "sphere, box, capsule, mesh, points"},
        BadScene{"two shapes", old_text,
                 "sphere: {center: [0.5, 0.7, 0.5], radius: 0.2}, box: {center: [0.5, 0.5, 0.5], size: [0.1, 0.1, 0.1]}",
                 "{center: [0.5, 0.5, 0.5], size", "both 'sphere' and 'box'"},
        BadScene{"no material", "material: ball, ", "", "{sphere: {center", "material"},
        BadScene{"no radius", ", radius: 0.21", "", "{center: [0.5, 0.7, 0.51]", "radius"},
        BadScene{"no center", "center: [0.5, 0.7, 0.51], ", "", "{radius: 0.21", "center"},
        BadScene{"box of no size", old_text, "box: {center: [0.5, 0.7, 0.5], size: [0.1, 0, 0.1]}", "0, 0.1]}", "size"},
        BadScene{"box upside down", old_text, "box: {min: [0.3, 0.7, 0.3], max: [0.5, 0.6, 0.5]}", "[0.5, 0.6, 0.5]", "along y"},
        BadScene{"box given twice", old_text, "box: {center: [0.5, 0.7, 0.5], size: [0.1, 0.1, 0.1], min: [0.1, 0.1, 0.1]}",
                 "{center: [0.5, 0.7, 0.5], s", "not by both"},
        BadScene{"capsule of no length", old_text, "capsule: {from: [0.5, 0.7, 0.5], to: [0.5, 0.7, 0.5], radius: 0.1}",
                 "[0.5, 0.7, 0.5], radius", "differ"},
        BadScene{"quaternion of length 90", old_text,
                 "sphere: {center: [0.5, 0.7, 0.51], radius: 0.21}, orientation: [0, 90, 0, 1]", "[0, 90, 0, 1]", "length 1"},
        BadScene{"axis zero", old_text,
                 "sphere: {center: [0.5, 0.7, 0.51], radius: 0.21}, orientation: {axis: [0, 0, 0], degrees: 5}", "[0, 0, 0], deg",
                 "axis"},
        BadScene{"missing points", old_text + ", material: ball, velocity: [1, 0, 0], spin: [0, 0, 2], per_cell: 8",
                 "points: {file: nowhere.npy, mass: 1}, material: ball", "nowhere.npy", "does not exist"}})
    check_bad(bad);
}

TEST_CASE("snow of too many particles is an error that tells count and memory") {
  std::string text = base;
  const auto replace = [&](const std::string& old_text, const std::string& new_text) {
    text.replace(text.find(old_text), old_text.size(), new_text);
  };
  replace("max: [2, 1.5, 1], cell: 0.05", "max: [600, 600, 200], cell: 0.5");  // 1200 x 1200 x 400 cells
  replace("sphere: {center: [0.5, 0.7, 0.51], radius: 0.21}", "box: {min: [1, 1, 1], max: [599, 599, 199]}");
  const ReadResult result = read_text(text);
  INFO(result.text());
  REQUIRE(result.diagnostics.all().size() == 1);
  CHECK(result.diagnostics.all()[0].text.find("2^31") != std::string::npos);
  CHECK(result.diagnostics.all()[0].text.find("GiB") != std::string::npos);
  CHECK(result.diagnostics.all()[0].text.find("particles") != std::string::npos);
}

TEST_CASE("snow without a domain, and nothing to simulate, are errors") {
  check_bad({"no domain", "domain: {min: [0, 0, 0], max: [2, 1.5, 1], cell: 0.05}\n", "", "{sphere: {center", "needs a domain"});
  const ReadResult none = read_text("firn: 1\nname: empty\n");
  REQUIRE(none.diagnostics.all().size() == 1);
  CHECK(none.diagnostics.all()[0].text.find("nothing to simulate") != std::string::npos);
  const ReadResult empty = read_text("firn: 1\nsnow: []\nbodies: []\n");
  REQUIRE(empty.diagnostics.all().size() == 1);
  CHECK(empty.diagnostics.all()[0].text.find("nothing to simulate") != std::string::npos);
}

TEST_CASE("a field that cannot be is an error") {
  for (const BadScene& bad :
       {BadScene{"cells not square", "cells: [64, 32]", "cells: [64, 31]", "[64, 31]", "square"},
        BadScene{"no size", "size: [4, 2], ", "", "{cells: [64", "size"},
        BadScene{"no depth", "depth: 0.4, ", "", "{size: [4", "depth"},
        BadScene{"density above the material's", "density: 120", "density: 151", "151", "50 (min_density) to 150 (max_density)"},
        BadScene{"density below the material's", "density: 120", "density: 49", "49", "50 (min_density)"},
        BadScene{"image missing", "depth: 0.4", "depth: {image: none.png, metres: 1}", "none.png", "does not exist"},
        BadScene{"too many", "size: [4, 2], cells: [64, 32]", "size: [4, 4], cells: [65536, 65536]", "[65536, 65536]", "2^31"}})
    check_bad(bad);
}

TEST_CASE("a field's image of densities may not be whiter than its material is dense") {
  const TemporaryFolder folder;
  folder.write("a.png", "an image");
  check_bad({"white", "density: 120", "density: {image: a.png, density: 151}", "{image", "151 kg/m3 at white"},
            folder / "scene.yaml");
}

TEST_CASE("a field that takes its material's density is checked like any other") {
  std::string text = base;
  text.replace(text.find("density: 120, material: new_snow"), 32, "material: ball");
  text.replace(text.find("density: 410"), 12, "density: 500");
  const ReadResult result = read_text(text);
  INFO(result.text());
  REQUIRE(result.diagnostics.all().size() == 1);
  CHECK(result.diagnostics.all()[0].text.find("90 (min_density) to 480 (max_density)") != std::string::npos);
}

TEST_CASE("a body that cannot be is an error") {
  const std::string shape = "sphere: {radius: 0.1}", place = "position: [1.5, 0.6, 0.52], mass: 4";
  for (const BadScene& bad :
       {BadScene{"normal zero", "normal: [0, 1, 0]", "normal: [0, 0, 0]", "[0, 0, 0]}, f", "must not be zero"},
        BadScene{"no normal", ", normal: [0, 1, 0]", "", "{point", "normal"},
        BadScene{"no shape", shape + ", ", "", "{name: stone", "plane, sphere, box, capsule, mesh"},
        BadScene{"plane with mass", "friction: 0.31", "mass: 5", "5}\n  - {sph", "plane"},
        BadScene{"mesh missing", shape, "mesh: {file: gone.obj}", "gone.obj", "does not exist"},
        BadScene{"place twice", shape, "sphere: {center: [1, 1, 1], radius: 0.1}", "{center: [1, 1, 1]", "given twice"},
        BadScene{"capsule off its middle", shape, "capsule: {from: [0, 0, 0], to: [0, 0.2, 0], radius: 0.1}", "{from: [0, 0, 0]",
                 "from: [0, -0.1, 0], to: [0, 0.1, 0]"},
        BadScene{"path backwards", place,
                 "path: [{t: 0, position: [1, 1, 0.5]}, {t: 1, position: [1, 1, 0.5]}, {t: 0.5, position: [1, 1, 0.5]}]",
                 "0.5, position", "must ascend"},
        BadScene{"path twice at once", place, "path: [{t: 0, position: [1, 1, 0.5]}, {t: 0.0, position: [1, 1, 0.5]}]",
                 "0.0, position", "must ascend"},
        BadScene{"path without place", place, "path: [{t: 0}]", "{t: 0}", "position"},
        BadScene{"path and velocity", place, "velocity: [1, 0, 0], path: [{t: 0, position: [1, 1, 0.5]}]", "[1, 0, 0], path",
                 "no effect"},
        BadScene{"names twice", "friction: 0.31", "friction: 0.31, name: stone", stone, "'stone'"},
        BadScene{"outside", place, "position: [1.5, 0.6, 1.2]", "{sphere: {radius: 0.1}", "body outside the domain"},
        BadScene{"outside, and going away", place, "position: [1.5, 0.6, 1.2], velocity: [0, 0, 1]", "{sphere: {radius: 0.1}",
                 "body outside the domain"}})
    check_bad(bad);
}

TEST_CASE("a body may stick out of the domain, and may come in from outside") {
  const std::string old_text = "position: [1.5, 0.6, 0.52], mass: 4";
  for (const char* place :
       {"position: [1.5, 0.6, 1.05]", "position: [1.5, 0.6, 1.2], velocity: [0, 0, -1]", "position: [1.5, 2.5, 0.5], mass: 4",
        "path: [{t: 0, position: [1.5, 0.6, 3]}, {t: 1, position: [1.5, 0.6, 0.5]}]"}) {
    INFO(place);
    std::string text = base;
    text.replace(text.find(old_text), old_text.size(), place);
    good_scene(text);
  }
}

TEST_CASE("a camera without direction and a dark sun are errors") {
  check_bad({"camera", "to: [4, 1, 3]", "to: [6, 4, 9]", "{from", "same point"});
  check_bad({"sun", "sun: [-0.4, -1, -0.3]", "sun: [0, 0, 0]", "{sun", "must not be zero"});
}

TEST_CASE("points are checked as far as their header tells") {
  const TemporaryFolder folder;
  const std::vector<double> values(8, 0.5);
  scene::write_npy(folder / "flat.npy", {4, 2}, std::span<const double>(values));
  const std::vector<std::int32_t> whole(6, 1);
  scene::write_npy(folder / "whole.npy", {2, 3}, std::span<const std::int32_t>(whole));
  scene::write_npy(folder / "none.npy", {0, 3}, std::span<const float>());
  folder.write("text.npy", "x y z\n");
  const std::string old_text =
      "sphere: {center: [0.5, 0.7, 0.51], radius: 0.21}, material: ball, velocity: [1, 0, 0], spin: [0, 0, 2], per_cell: 8";
  const auto points = [&](const std::string& file, const std::string& more) {
    return "points: {file: " + file + ", mass: 1}, material: ball" + more;
  };
  const std::filesystem::path scene = folder / "scene.yaml";
  check_bad({"two columns", old_text, points("flat.npy", ""), "flat.npy", "(N, 3)"}, scene);
  check_bad({"integers", old_text, points("whole.npy", ""), "whole.npy", "float32"}, scene);
  check_bad({"no rows", old_text, points("none.npy", ""), "none.npy", "no points"}, scene);
  check_bad({"no array", old_text, points("text.npy", ""), "text.npy", "NUMPY"}, scene);
  scene::write_npy(folder / "good.npy", {2, 3}, std::span<const double>(values).first(6));
  check_bad({"per_cell", old_text, points("good.npy", ", per_cell: 4"), "4}\nfield", "no meaning for points"}, scene);
  check_bad({"orientation", old_text, points("good.npy", ", orientation: [0, 0, 0, 1]"), "[0, 0, 0, 1]", "no meaning for points"},
            scene);
}

TEST_CASE("all errors of a scene are told at once, each at its place") {
  std::string text = base;
  const auto replace = [&](const std::string& old_text, const std::string& new_text) {
    text.replace(text.find(old_text), old_text.size(), new_text);
  };
  replace("fps: 25", "fps: -25");
  replace("preset: packed", "preset: packd");
  replace("radius: 0.21", "radius: 0.9");  // sticks out on every side but high x
  replace("cells: [64, 32]", "cells: [64, 33]");
  replace("normal: [0, 1, 0]", "normal: [0, 0, 0]");
  replace("fov: 42", "fov: 420, roll: 1");
  const ReadResult result = read_text(text);
  INFO(result.text());
  CHECK(result.diagnostics.all().size() == 11);
  std::vector<int> lines;
  for (const config::Diagnostic& each : result.diagnostics.all()) lines.push_back(each.place.line);
  std::sort(lines.begin(), lines.end());
  CHECK(lines == std::vector<int>{5, 9, 12, 12, 12, 12, 12, 13, 15, 17, 17});
}

}  // namespace firn::test
