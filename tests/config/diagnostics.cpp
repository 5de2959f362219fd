#include "config/diagnostics.h"

#include <string>

#include "tests/catch.h"

using namespace firn::config;

TEST_CASE("a diagnostic is one line: file, line, column, severity, text") {
  CHECK(to_string(Diagnostic{Severity::error, {"a.yaml", 3, 7}, "wrong"}) == "a.yaml:3:7: error: wrong");
  CHECK(to_string(Diagnostic{Severity::warning, {"a.yaml", 3, 7}, "odd"}) == "a.yaml:3:7: warning: odd");
}

TEST_CASE("line and column are left out where the place is the whole file") {
  CHECK(to_string(Diagnostic{Severity::error, {"a.yaml", 0, 0}, "missing"}) == "a.yaml: error: missing");
  CHECK(to_string(Diagnostic{Severity::error, {"a.yaml", 4, 0}, "wrong"}) == "a.yaml:4: error: wrong");
  CHECK(to_string(Diagnostic{Severity::error, {"", 0, 0}, "wrong"}) == "error: wrong");
  CHECK(to_string(Place{"a.yaml", 3, 7}) == "a.yaml:3:7");
}

TEST_CASE("warnings alone are no errors") {
  Diagnostics diagnostics;
  CHECK_FALSE(diagnostics.has_errors());
  diagnostics.warning({"a.yaml", 1, 1}, "odd");
  CHECK_FALSE(diagnostics.has_errors());
  throw_if_errors(diagnostics);
  diagnostics.error({"a.yaml", 2, 1}, "wrong");
  CHECK(diagnostics.has_errors());
}

TEST_CASE("the exception carries everything that was found, one line each") {
  Diagnostics diagnostics;
  diagnostics.warning({"a.yaml", 1, 1}, "odd");
  diagnostics.error({"a.yaml", 2, 1}, "wrong");
  std::string text;
  try {
    throw_if_errors(diagnostics);
  } catch (const InputError& error) {
    text = error.what();
    CHECK(error.diagnostics().all().size() == 2);
  }
  CHECK(text == "a.yaml:1:1: warning: odd\na.yaml:2:1: error: wrong");
}

TEST_CASE("diagnostics can be appended, to themselves too") {
  Diagnostics first;
  Diagnostics second;
  first.error({"a.yaml", 1, 1}, "one");
  second.error({"a.yaml", 2, 1}, "two");
  first.append(second);
  first.append(first);
  REQUIRE(first.all().size() == 4);
  CHECK(first.all()[1].text == "two");
  CHECK(first.all()[3].text == "two");
}

TEST_CASE("equal errors are told once, in the place of the first") {
  Diagnostics diagnostics;
  for (const char* text : {"wrong", "odd", "wrong"}) diagnostics.error({"--set a.b=1", 0, 0}, text);
  diagnostics.error({"--set a.b=2", 0, 0}, "wrong");
  CHECK(std::string(InputError(diagnostics).what()) ==
        "--set a.b=1: error: wrong\n--set a.b=1: error: odd\n--set a.b=2: error: wrong");
}
