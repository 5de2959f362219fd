#include <clocale>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "config/reader.h"
#include "tests/config/support.h"

using namespace firn::config;
using namespace firn::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The value, or the text of the one error.
struct Number {
  std::optional<double> value;
  std::string error;
};

Number number(const std::string& yaml, const Range& range = {}) {
  Diagnostics diagnostics;
  const auto value = read_number(parse_good("k: " + yaml).entries[0].value, "density", range, diagnostics);
  REQUIRE(diagnostics.all().size() == (value ? 0U : 1U));
  return {value, value ? "" : to_string(diagnostics.all()[0])};
}

struct Integer {
  std::optional<std::int64_t> value;
  std::string error;
};

Integer integer(const std::string& yaml, const Range& range = {}) {
  Diagnostics diagnostics;
  const auto value = read_integer(parse_good("k: " + yaml).entries[0].value, "count", range, diagnostics);
  REQUIRE(diagnostics.all().size() == (value ? 0U : 1U));
  return {value, value ? "" : to_string(diagnostics.all()[0])};
}

}  // namespace

TEST_CASE("numbers are read in every form of YAML's core schema") {
  const std::vector<std::pair<std::string, double>> forms = {
      {"400", 400},     {"-3", -3},         {"+2", 2},
      {"1e-4", 1e-4},   {"1.0e-4", 1e-4},   {".5", 0.5},
      {"5.", 5},        {"-.5", -0.5},      {"+.5e1", 5},
      {"1E+3", 1000},   {"0x10", 16},       {"0xfF", 255},
      {"0o17", 15},     {"007", 7},         {"1e-400", 0},
      {"-0.0", -0.0},   {"!!float 3", 3.0}, {"0.1", 0.1},
      {"1e308", 1e308}, {"5e-324", 5e-324}, {"12345678901234567890", 12345678901234567890.0}};
  for (const auto& [text, value] : forms) {
    CAPTURE(text);
    CHECK(number(text).value == value);
  }
}

TEST_CASE("numbers are read the same in every locale") {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) == nullptr) continue;
    CHECK(number("1.5").value == 1.5);
    CHECK_FALSE(number("1,5").value.has_value());
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST_CASE("numbers that are not finite are refused") {
  for (const char* text :
       {".nan", ".NaN", "nan", "NaN", ".inf", "-.inf", "+.Inf", "inf", "-inf", "infinity", "-Infinity", "1e999", "-1e400"}) {
    CAPTURE(text);
    CHECK(contains(number(text).error, "a.yaml:1:4: error: density must be a finite number, not '"));
    CHECK(contains(integer(text).error, "count must be a finite whole number, not '"));
  }
}

TEST_CASE("what is no number is refused, with help where the fault is a common one") {
  CHECK(number("1,5").error == "a.yaml:1:4: error: density must be a number, not '1,5'; write a decimal point: 1.5");
  CHECK(number("0.1m").error == "a.yaml:1:4: error: density must be a number, not '0.1m'; write the number without a unit: 0.1");
  CHECK(contains(number("1e3 Pa").error, "write the number without a unit: 1e3"));
  CHECK(contains(number("30°").error, "without a unit: 30"));
  CHECK(number("'5'").error == "a.yaml:1:4: error: density must be a number, not '5'; remove the quotes");
  CHECK(number("'soft'").error == "a.yaml:1:4: error: density must be a number, not 'soft'");
  CHECK(number("[1]").error == "a.yaml:1:4: error: density must be a number, not a list");
  CHECK(number("{a: 1}").error == "a.yaml:1:4: error: density must be a number, not a map");
  CHECK(number("").error == "a.yaml:1:1: error: density must be a number, not nothing");
  for (const char* text : {"true", "soft",  "1e",  "1e+",   "--1",   "+-1",   ".",   "-",     "+",     "e5",   "0x",
                           "0xg",  "-0x10", "0o8", "1_000", "1 000", "1.2.3", "1/3", "0x1p3", "1e5.5", "12:30"}) {
    CAPTURE(text);
    CHECK(contains(number(text == std::string("-") ? "'-'" : text).error, "density must be a number, not '"));
  }
}

TEST_CASE("a range says what it allows") {
  CHECK(describe(Range{}) == "any number");
  CHECK(describe(Range{0, infinity, true}) == "greater than 0");
  CHECK(describe(Range{1, infinity}) == "at least 1");
  CHECK(describe(Range{-infinity, 5}) == "at most 5");
  CHECK(describe(Range{-infinity, 5, false, true}) == "less than 5");
  CHECK(describe(Range{0, 0.5}) == "between 0 and 0.5");
  CHECK(describe(Range{0, 0.5, true, true}) == "greater than 0 and less than 0.5");
  CHECK(describe(Range{0, 0.5, true}) == "greater than 0 and at most 0.5");
  CHECK(describe(Range{0, 0.5, false, true}) == "at least 0 and less than 0.5");
}

TEST_CASE("a range holds its ends unless they are open") {
  CHECK(contains(Range{0, 1}, 0));
  CHECK(contains(Range{0, 1}, 1));
  CHECK_FALSE(contains(Range{0, 1, true, false}, 0));
  CHECK_FALSE(contains(Range{0, 1, false, true}, 1));
  CHECK_FALSE(contains(Range{0, 1}, 1.5));
  CHECK_FALSE(contains(Range{}, std::nan("")));
  CHECK(contains(Range{}, -1e300));
}

TEST_CASE("a number out of its range is refused") {
  CHECK(number("-3", {0, infinity, true}).error == "a.yaml:1:4: error: density must be greater than 0, not -3");
  CHECK(number("0", {0, infinity, true}).error == "a.yaml:1:4: error: density must be greater than 0, not 0");
  CHECK(number("0.7", {0, 0.5}).error == "a.yaml:1:4: error: density must be between 0 and 0.5, not 0.7");
  CHECK(number("0.5", {0, 0.5}).value == 0.5);
  CHECK(integer("0", {1}).error == "a.yaml:1:4: error: count must be at least 1, not 0");
  CHECK(integer("1", {1}).value == 1);
}

TEST_CASE("whole numbers are accepted in any form that is whole") {
  const std::vector<std::pair<std::string, std::int64_t>> forms = {{"8", 8},
                                                                   {"-8", -8},
                                                                   {"+8", 8},
                                                                   {"8.0", 8},
                                                                   {"1e3", 1000},
                                                                   {"1.5e1", 15},
                                                                   {"0x10", 16},
                                                                   {"0o17", 15},
                                                                   {"0", 0},
                                                                   {"9007199254740993", 9007199254740993},
                                                                   {"-0.0", 0},
                                                                   {"!!int 4", 4},
                                                                   {"9223372036854775807", INT64_MAX},
                                                                   {"-9223372036854775808", INT64_MIN}};
  for (const auto& [text, value] : forms) {
    CAPTURE(text);
    CHECK(integer(text).value == value);
  }
}

TEST_CASE("what is not whole or does not fit is no whole number") {
  CHECK(integer("8.5").error == "a.yaml:1:4: error: count must be a whole number, not '8.5'");
  CHECK(contains(integer("1e-3").error, "count must be a whole number, not '1e-3'"));
  CHECK(contains(integer("9223372036854775808").error, "count must be a whole number of at most 64 bits"));
  CHECK(contains(integer("-9223372036854775809").error, "64 bits"));
  CHECK(contains(integer("1e19").error, "64 bits"));
  CHECK(contains(integer("0xFFFFFFFFFFFFFFFF").error, "64 bits"));
  CHECK(contains(integer("'8'").error, "remove the quotes"));
  CHECK(contains(integer("eight").error, "count must be a whole number, not 'eight'"));
  CHECK(contains(integer("1,5").error, "write a decimal point"));
}

TEST_CASE("booleans are true and false, nothing else") {
  const auto boolean = [](const std::string& yaml, Diagnostics& diagnostics) {
    return read_boolean(parse_good(yaml), "wet", diagnostics);
  };
  Diagnostics good;
  CHECK(boolean("true", good) == true);
  CHECK(boolean("True", good) == true);
  CHECK(boolean("false", good) == false);
  CHECK(boolean("FALSE", good) == false);
  CHECK(good.all().empty());
  for (const char* text : {"yes", "no", "on", "off", "y", "1", "0", "tRUE", "'true'", "null", "[true]"}) {
    CAPTURE(text);
    Diagnostics bad;
    CHECK_FALSE(boolean(text, bad).has_value());
    REQUIRE(bad.all().size() == 1);
    CHECK(contains(bad.all()[0].text, "write true or false"));
  }
}

TEST_CASE("a text is any scalar") {
  Diagnostics good;
  CHECK(read_text(parse_good("snow"), "name", good) == "snow");
  CHECK(read_text(parse_good("''"), "name", good) == "");
  CHECK(read_text(parse_good("5"), "name", good) == "5");
  CHECK(good.all().empty());
  for (const char* text : {"[a]", "{a: b}", "null"}) {
    Diagnostics bad;
    CHECK_FALSE(read_text(parse_good(text), "name", bad).has_value());
    REQUIRE(bad.all().size() == 1);
    CHECK(bad.all()[0].text.starts_with("name must be a text, not "));
  }
}

TEST_CASE("a vector is a list of exactly 3 numbers, each in its range") {
  Diagnostics good;
  CHECK(read_vector3(parse_good("[0, -9.81, 1e-3]"), "gravity", {}, good) == Vector3{0, -9.81, 1e-3});
  CHECK(good.all().empty());
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"[1, 2]", "gravity must be a list of 3 numbers like [0, 1.5, 0], not a list of 2"},
      {"[1, 2, 3, 4]", "gravity must be a list of 3 numbers like [0, 1.5, 0], not a list of 4"},
      {"9.81", "gravity must be a list of 3 numbers like [0, 1.5, 0], not '9.81'"},
      {"null", "gravity must be a list of 3 numbers like [0, 1.5, 0], not nothing"},
      {"{x: 1}", "gravity must be a list of 3 numbers like [0, 1.5, 0], not a map"},
      {"[0, x, 0]", "gravity[1] must be a number, not 'x'"},
      {"[0, 0, .nan]", "gravity[2] must be a finite number, not '.nan'"},
      {"[0, -1, 0]", "gravity[1] must be at least 0, not -1"},
  };
  for (const auto& [text, error] : bad) {
    Diagnostics diagnostics;
    CHECK_FALSE(read_vector3(parse_good(text), "gravity", {0}, diagnostics).has_value());
    REQUIRE(diagnostics.all().size() == 1);
    CHECK(diagnostics.all()[0].text == error);
  }
  Diagnostics every;
  read_vector3(parse_good("[a, b, 0]"), "gravity", {}, every);
  CHECK(every.all().size() == 2);
}

TEST_CASE("a choice is one of its names") {
  Diagnostics diagnostics;
  const std::vector<std::string> choices = {"explicit", "implicit"};
  CHECK(read_choice(parse_good("implicit"), "solver", choices, diagnostics) == "implicit");
  CHECK(read_choice(parse_good("'explicit'"), "solver", choices, diagnostics) == "explicit");
  CHECK(diagnostics.all().empty());
  CHECK_FALSE(read_choice(parse_good("implict"), "solver", choices, diagnostics).has_value());
  CHECK_FALSE(read_choice(parse_good("euler"), "solver", choices, diagnostics).has_value());
  CHECK_FALSE(read_choice(parse_good("[implicit]"), "solver", choices, diagnostics).has_value());
  CHECK(texts(diagnostics) == std::vector<std::string>{"a.yaml:1:1: error: solver cannot be 'implict'; did you mean 'implicit'?",
                                                       "a.yaml:1:1: error: solver cannot be 'euler'; valid: explicit, implicit",
                                                       "a.yaml:1:1: error: solver must be a text, not a list"});
}
