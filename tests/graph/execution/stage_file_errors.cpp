#include "graph/execution/stage_file_errors.h"

#include "tests/catch.h"

// Messages of drivers about the file of a stage. What they say is made up in their manners, not compiled.

namespace firn::test {
namespace {

const std::string file = "/mine/blur.comp";

gpu::ShaderSource source() {
  return {
      "#version 430 core\nuniform block { float radius; };\nbuffer x_block { vec3 velocity[]; };\n#define HAS_WIND 0\n"
      "#line 1 1\n#include\n#line 1 2\nfloat smoothed(float some_value) { return some_value; }\n#line 2 1\nvoid main() {\n  float "
      "amount = 1;\n}\n",
      {"generated", file, "/lib/smooth.glsl"}};
}

std::vector<std::string> told(const std::string& what) {
  const config::Diagnostics errors = execution::stage_file_errors(what, source(), file);
  std::vector<std::string> lines;
  for (const config::Diagnostic& one : errors.all()) lines.push_back(config::to_string(one));
  return lines;
}

std::string told_of(const std::string& message) {
  const std::vector<std::string> lines = told("'blur' does not compile:\n" + file + ":7: error: " + message);
  REQUIRE(lines.size() == 1);
  return lines[0];
}

TEST_CASE("a name that a driver does not know is told with the nearest that is declared") {
  const std::string place = file + ":7: error: ";
  CHECK(told_of("`radus' undeclared") == place + "`radus' undeclared; did you mean 'radius'?");
  CHECK(told_of("C1503: undefined variable \"velocty\"") ==
        place + "C1503: undefined variable \"velocty\"; did you mean 'velocity'?");
  CHECK(told_of("'amuont' : undeclared identifier") == place + "'amuont' : undeclared identifier; did you mean 'amount'?");
  CHECK(told_of("no function with name 'smothed'") == place + "no function with name 'smothed'; did you mean 'smoothed'?");
  CHECK(told_of("`HAS_WNID' undeclared") == place + "`HAS_WNID' undeclared; did you mean 'HAS_WIND'?");
}

TEST_CASE("nothing is proposed where nothing is near, where the name is there, or where a message is not about a name") {
  for (const std::string message : {"`temperature' undeclared", "`some_valeu' undeclared",
                                    "'smoothed' : no matching overloaded function", "type mismatch in `radus'", "undeclared"})
    CHECK(told_of(message) == file + ":7: error: " + message);
}

TEST_CASE("every message keeps its place, warnings stay warnings, and what has no line is told of the file") {
  CHECK(told("'blur' does not compile:\n" + file + ":2: warning: unused\n/lib/smooth.glsl:1: error: bad") ==
        std::vector<std::string>{file + ":2: warning: unused", "/lib/smooth.glsl:1: error: bad"});
  CHECK(told("'blur' does not link:\nno definition of main") ==
        std::vector<std::string>{file + ": error: 'blur' does not link: no definition of main"});
  CHECK(told(file + ": error: the file cannot be read") == std::vector<std::string>{file + ": error: the file cannot be read"});
}

}  // namespace
}  // namespace firn::test
