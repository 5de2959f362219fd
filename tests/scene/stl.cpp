#include "scene/stl.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "scene/mesh.h"
#include "tests/scene/bad_file_table.h"
#include "tests/scene/support.h"

namespace firn::test {
namespace {

using scene::StlTriangle;

const std::string facet =
    "facet normal 0 0 1\n"
    "  outer loop\n"
    "    vertex 0 0 0\n"
    "    vertex 1.5 0 -2e-1\n"
    "    vertex 0 +1 0\n"
    "  endloop\n"
    "endfacet\n";

// As many triangles as `corners` has nines of values, whose number is written as `count`.
std::string binary(const std::vector<float>& corners, std::uint32_t count, const std::string& header = "") {
  std::string bytes = header;
  bytes.resize(80, ' ');
  bytes += raw<std::uint32_t>({count});
  for (std::size_t at = 0; at + 9 <= corners.size(); at += 9)
    bytes += raw<float>({NAN, INFINITY, 7}) +
             raw(std::vector<float>(corners.begin() + static_cast<long>(at), corners.begin() + static_cast<long>(at) + 9)) + "ab";
  return bytes;
}

const std::vector<float> one = {0, 0, 0, 1.5F, 0, -0.2F, 0, 1, 0};

std::string error_of(const std::string& bytes) {
  try {
    static_cast<void>(scene::parse_stl(bytes, "a.stl"));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("binary and text STL give the corners that stand in them, whatever the normals are") {
  const std::vector<StlTriangle> text = scene::parse_stl("solid two words\n" + facet + facet + "endsolid\n", "a.stl"),
                                 packed = scene::parse_stl(binary(one, 1), "a.stl");
  REQUIRE(text.size() == 2);
  REQUIRE(packed.size() == 1);
  for (const StlTriangle& triangle : {text[0], text[1], packed[0]})
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis) CHECK(triangle[corner][axis] == one[corner * 3 + static_cast<std::size_t>(axis)]);
}

TEST_CASE("a binary STL whose header begins as a text is binary") {
  CHECK(scene::parse_stl(binary(one, 1, "solid but not a text"), "a.stl").size() == 1);
}

TEST_CASE("text STL may be of capitals, of several solids, with names or none, indented or not, with any ends of lines") {
  std::string capitals = facet;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string returns;
  for (const char c : facet) returns += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(scene::parse_stl("SOLID\n" + capitals + "ENDSOLID", "a.stl").size() == 1);
  CHECK(scene::parse_stl("\n  solid a\n" + facet + "endsolid a\nsolid facet\n" + facet + "endsolid facet\n\n", "a.stl").size() ==
        2);
  CHECK(scene::parse_stl("solid a\r\n" + returns + "endsolid a\r\n", "a.stl").size() == 1);
  CHECK(scene::parse_stl("solid none\nendsolid\n", "a.stl").empty());
}

TEST_CASE("text STL that is not as it should be is an error that names file and line") {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = "solid a\n" + facet + "endsolid a\n";
    text.replace(text.find(from), from.size(), to);
    return error_of(text);
  };
  CHECK(with("outer", "inner") == "a.stl: line 3: 'outer' must stand here, not 'inner'");
  CHECK(with("0 0 1\n", "0 0\n") == "a.stl: line 3: 'outer' must stand here, not 'loop'");
  CHECK(with("1.5", "1,5") == "a.stl: line 5: a coordinate must be a number, not '1,5'");
  CHECK(with("1.5", "nan") == "a.stl: line 5: a coordinate must be finite, at most 3.4e+38, not 'nan'");
  CHECK(with("1.5", "-inf") == "a.stl: line 5: a coordinate must be finite, at most 3.4e+38, not '-inf'");
  CHECK(with("1.5", "-1e39") == "a.stl: line 5: a coordinate must be finite, at most 3.4e+38, not '-1e39'");
  CHECK(with("1.5", "1e999") == "a.stl: line 5: a coordinate must be finite, at most 3.4e+38, not '1e999'");
  CHECK(with("1.5", "\x01\x02") == "a.stl: line 5: a coordinate must be a number, not something else");
  CHECK(with("    vertex 0 +1 0\n", "") == "a.stl: line 6: 'vertex' must stand here, not 'endloop'");
  CHECK(with("  endloop", "    vertex 0 0 1\n  endloop") == "a.stl: line 7: 'endloop' must stand here, not 'vertex'");
  CHECK(with("endfacet\n", "") == "a.stl: line 8: 'endfacet' must stand here, not 'endsolid'");
  CHECK(with("endsolid a\n", "") == "a.stl: line 9: the file ends where 'facet' or 'endsolid' should follow; is it cut off?");
  CHECK(with("endsolid a\n", "end") == "a.stl: line 9: 'facet' or 'endsolid' must stand here, not 'end'");
  CHECK(with("endsolid a\n", "endsolid a\nmore") == "a.stl: line 10: 'solid' must stand here, not 'more'");
  CHECK(with("solid a\n", "solid a ").find("a.stl: line 2: 'facet' or 'endsolid' must stand here, not 'outer'") == 0);
}

TEST_CASE("binary STL must be as long as its number of triangles says, and have finite corners") {
  CHECK(error_of(binary(one, 2)) == "a.stl: this binary .stl file promises 2 triangles, 184 bytes in all, but has 134");
  CHECK(error_of(binary(one, 0)) == "a.stl: this binary .stl file promises 0 triangles, 84 bytes in all, but has 134");
  CHECK(error_of(binary(one, 1) + "x") == "a.stl: this binary .stl file promises 1 triangles, 134 bytes in all, but has 135");
  CHECK(error_of(binary(one, 4294967295U)).find("promises 4294967295 triangles, 214748364834 bytes in all") != std::string::npos);
  CHECK(error_of("x").find("a.stl: this .stl file has 1 bytes") == 0);
  for (const float wrong : {NAN, INFINITY, -INFINITY}) {
    std::vector<float> corners = one;
    corners.insert(corners.end(), one.begin(), one.end());
    corners[13] = wrong;
    CHECK(error_of(binary(corners, 2)).find("a.stl: triangle 2: a corner is (1.5, ") == 0);
  }
}

TEST_CASE("corners of an STL mesh in one place are one point") {
  const TemporaryFolder folder;
  std::vector<float> square;
  for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
    square.insert(square.end(), {static_cast<float>(x), static_cast<float>(y), x == 0 ? -0.0F : 0.0F});
  folder.write("a.stl", binary(square, 2));
  const scene::TriangleMesh mesh = scene::read_mesh((folder / "a.stl").string(), 3);
  CHECK(mesh.points.size() == 4);
  CHECK(mesh.triangles.size() == 2);
  CHECK(mesh.points[2] == scene::Vector3d(3, 3, 0));
}

}  // namespace firn::test
