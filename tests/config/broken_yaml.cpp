// Texts that are wrong, and what is said about them. None may crash, hang or pass.

#include <chrono>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "tests/config/support.h"

using namespace firn::config;
using namespace firn::test;
using namespace std::string_view_literals;

namespace {

struct Broken {
  std::string_view text;
  std::string_view place;  // line:column, empty for the whole file
  std::string_view part;   // of the error
};

const std::vector<Broken> broken = {
    {"", "", "the file is empty"},
    {"\n\n", "", "the file is empty"},
    {"# only\n# comments\n", "", "the file is empty"},
    {"a:\n\tb: 1", "2:1", "a tab indents this line"},
    {"a:\n  b: 1\n\tc: 2", "3:1", "a tab indents this line"},
    {"a:\n  b: 1\n  \tc: 2", "3:3", "a tab indents this line"},
    {"- 1\n\t- 2", "2:1", "a tab indents this line"},
    {"\ta: 1", "1:1", "a tab indents this line"},
    {"a: {b: 1", "1:4", "',' or '}' expected: the '{' of line 1, column 4 is still open"},
    {"a: [1, 2", "1:4", "',' or ']' expected: the '[' of line 1, column 4 is still open"},
    {"x:\n  a: [1, 2\nb: 3\n", "3:2", "the '[' of line 2, column 6 is still open"},
    {"a: {x: 1\nb: 2", "2:2", "the '{' of line 1, column 4 is still open"},
    {"{", "1:1", "still open"},
    {"[", "1:1", "still open"},
    {"a: [1 2}", "1:8", "closing bracket does not match"},
    {"a: 1\n]", "2:1", "closing bracket does not match"},
    {"a: [1, 2]]", "1:10", "closing bracket does not match"},
    {"a: 1\n b: 2", "2:3", "this ':' cannot stand here"},
    {"a: b: c", "1:5", "this ':' cannot stand here"},
    {"größe: b: c", "1:9", "this ':' cannot stand here"},
    {"a\nb: 1", "2:2", "this ':' cannot stand here"},
    {"a: 1\nb", "2:1", "':' is missing after the key 'b'"},
    {"m:\n  a: 1\n  b:2\n", "3:3", "a space is missing after ':' in 'b:2'"},
    {"a: - 1", "1:4", "a '- ' item cannot stand here"},
    {"a: 1\n- b", "2:1", "only another 'key: value' of the map begun on line 1 can stand here"},
    {"a:\n   b: 1\n  c: 2", "3:3", "only another 'key: value' of the map begun on line 1"},
    {"a: \"b\" c", "1:8", "whether a text needs quotes"},
    {"a: 'it's'", "1:8", "whether a text needs quotes"},
    {"- - a\n - b\n  c: 1", "2:2", "only another '- ' item of the list begun on line 1"},
    {"- - - a: b\n c", "2:2", "only another '- ' item of the list begun on line 1"},
    {"a: 'x", "1:6", "is never closed"},
    {"b: 1\na: \"x\nc: 1\n", "2:4", "the text that begins with this quote is never closed"},
    {"a: &n !!str 'it''s\n\n", "1:13", "the text that begins with this quote is never closed"},
    {"\"", "1:1", "never closed"},
    {"a: '\n--- x'\n", "2:1", "inside of a quoted text"},
    {"a: \"C:\\dir\"", "1:9", "unknown escape '\\d'"},
    {"a: \"\\x4\"", "1:9", "hexadecimal digits"},
    {"a: \"\\uD800\"", "1:11", "no character of Unicode"},
    {"a: @x", "1:4", "a value cannot begin with '@'; put quotes around it"},
    {"a: `x", "1:4", "a value cannot begin with '`'"},
    {"a: %x", "1:4", "a value cannot begin with '%'"},
    {"a: |x\n x", "1:5", "may follow '|' or '>'"},
    {"a: *b", "1:4", "no '&name' stands above it"},
    {"&a [*a]", "1:5", "this alias stands inside of what it names"},
    {"a: * b", "1:5", "a name must follow '*'"},
    {"a: & b", "1:5", "a name must follow '&'"},
    {"a: &x &y 1", "1:7", "multiple anchors"},
    {"a: !!str !!int 1", "1:10", "multiple tags"},
    {"a: !!python/object:x.y 1", "1:4", "the tag '!!python/object:x.y' means nothing here; remove it"},
    {"!foo {a: 1}", "1:1", "the tag '!foo' means nothing here"},
    {"a: !!map [1]", "1:4", "the tag '!!map' means nothing here"},
    {"a: !!null 5", "1:4", "the tag '!!null' means nothing here"},
    {"a: !<", "1:6", "'>' expected"},
    {": 1", "1:1", "a key must be a text, not nothing"},
    {"[a, b]: 1", "1:1", "a key must be a text, not a list"},
    {"{a: 1}: 2", "1:1", "a key must be a text, not a map"},
    {"? [a]\n: b", "1:3", "a key must be a text, not a list"},
    {"m: {a: 1}\nb:\n  <<: {a: 1}", "3:3", "merge keys ('<<') are not supported"},
    {"a: 1\na: 2", "2:1", "duplicate key 'a': first given on line 1"},
    {"a: 1\n---\nb: 2", "2:1", "a second document begins here"},
    {"a: 1\n...\nb: 2", "3:1", "does not belong to what stands above"},
    {"[1, 2] 3", "1:8", "does not belong to what stands above"},
    {"- a\nb: 1", "2:1", "does not belong to what stands above"},
    {",,,", "1:1", "does not belong to what stands above"},
    {"a: {k: ${k}}", "1:9", "'${...}' inside of [ ] or { } needs quotes"},
    {"a: [${k}]", "1:6", "'${...}' inside of [ ] or { } needs quotes"},
    {"a: 1\nb: \xff", "2:4", "not a text in UTF-8: byte 0xff is part of no character"},
    {"a: \xc3", "1:4", "not a text in UTF-8: byte 0xc3"},
    {"a: \xc0\x80", "1:4", "byte 0xc0"},
    {"a: \xed\xa0\x80", "1:4", "byte 0xed"},
    {"a: \xf4\x90\x80\x80", "1:4", "byte 0xf4"},
    {"a: b\0c"sv, "1:5", "byte 0x00 is a control character"},
    {"a: b\x04 c", "1:5", "byte 0x04 is a control character"},
    {"\x89PNG\r\n\x1a\n\0\0"sv, "1:1", "not a text in UTF-8"},
    {"\xff\xfe"
     "a\0:\0"sv,
     "1:1", "it looks like UTF-16, save it as UTF-8"},
    {"%YAML 2.0\n---\na: 1", "1:1", "YAML major version too large"},
    {"%TAG x\n---\na", "1:1", "TAG directives"},
};

const std::string sample = R"(# a pipeline
title: "Snow \"wet\" \u00e9"
parameters: {k: 8, name: 'it''s'}
scene: &scene
  gravity: [0, -9.81, 0]
  bodies:
    - shape: {sphere: {centre: [0, 1, 0], radius: 0.5}}
      material: &wet {density: 400, "young": 1.4e5}
    - shape: !!str box
      material: *wet
text: |
  two
  lines
folded: >-
  one
  line
stages:
  - mpm.particles_to_grid
  - heightfield.contour: {k: "${k}"}
  - repeat: 4
    stages: [a, b, ~, null, "größe"]
? long key
: value
)";

}  // namespace

TEST_CASE("a broken text is an error with its place and a sentence") {
  for (const Broken& entry : broken) {
    CAPTURE(entry.text, entry.place);
    const auto errors = errors_of(entry.text);
    REQUIRE(errors.size() == 1);
    CAPTURE(errors[0]);
    CHECK(errors[0].starts_with("a.yaml" + std::string(entry.place.empty() ? "" : ":") + std::string(entry.place) + ": error: "));
    CHECK(contains(errors[0], entry.part));
    CHECK_FALSE(contains(errors[0], "\n"));
  }
}

TEST_CASE("texts that nest without end are errors, soon") {
  for (const std::string unit :
       {"[", "{", "- ", "? ", "{? ", "[? ", "? - ", "- ? ", ": ", "a: {", "[a: ", "[{", "{a: [", "a: [\n"}) {
    std::string text;
    while (text.size() < 100'000 * unit.size()) text += unit;
    CAPTURE(unit);
    const auto start = std::chrono::steady_clock::now();
    const auto errors = errors_of(text);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    CHECK(errors.size() == 1);
    if (!errors.empty()) CHECK(contains(errors[0], "nested more than 100 deep"));
    CHECK(seconds.count() < 20);  // what takes time with the square of the length takes minutes
  }
  std::string text;
  for (int i = 0; i < 2000; ++i) text += std::string(i, ' ') + "a:\n";
  const auto errors = errors_of(text);
  REQUIRE(errors.size() == 1);
  CHECK(contains(errors[0], "a.yaml:101:101: error: lists and maps are nested more than 100 deep"));
}

TEST_CASE("one character over and over neither crashes nor hangs") {
  for (const std::string unit : {"\"", "'", "a: ", "|",   "> ", "*a ",    "%a\n", "---\n", "a: 1\n---\n", "\t",    ",",
                                 ":",  "!", "!<",  "&a ", "\\", "!!str ", "a:\n", "- a: ", "#",           "a: \n "}) {
    std::string text;
    while (text.size() < 100'000) text += unit;
    CAPTURE(unit);
    const auto start = std::chrono::steady_clock::now();
    errors_of(text);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    CHECK(seconds.count() < 20);  // what takes time with the square of the length takes minutes
  }
}

TEST_CASE("random changes of a text are read or refused, and what is read can be written and read again") {
  INFO("seed " << seed());
  std::mt19937_64 random(seed());
  const auto below = [&](std::size_t count) { return static_cast<std::size_t>(random() % count); };
  const std::string_view characters = "[]{}:,-?&*!|>'\"%@`#\\ \n\t$~.<=0123ab\r\x01\xc3\xa9\xff";
  REQUIRE(errors_of(sample).empty());
  int read = 0;
  int refused = 0;
  for (int round = 0; round < 6000; ++round) {
    std::string text = sample;
    for (std::size_t edits = 1 + below(4); edits > 0; --edits) {
      const std::size_t at = below(text.size());
      switch (below(5)) {
        case 0:
          text.erase(at, 1 + below(8));
          break;
        case 1:
          text.insert(at, 1, characters[below(characters.size())]);
          break;
        case 2:
          text[at] = characters[below(characters.size())];
          break;
        case 3:
          text[at] = static_cast<char>(random());
          break;
        default:
          text.insert(below(text.size()), text.substr(at, 1 + below(30)));
          break;
      }
      if (text.empty()) text = "a";
    }
    CAPTURE(text);
    Diagnostics diagnostics;
    const Node node = parse(text, "a.yaml", diagnostics);
    if (diagnostics.has_errors()) {
      ++refused;
      for (const Diagnostic& diagnostic : diagnostics.all()) {
        if (diagnostic.text.empty() || diagnostic.place.line < 0) FAIL("an error without a sentence");
      }
    } else {
      ++read;
      const std::string written = to_yaml(node);
      CAPTURE(written);
      if (!same(parse_good(written), node)) FAIL("not the same after writing and reading");
    }
  }
  // Both must happen, or the test looks at nothing.
  CHECK(read > 500);
  CHECK(refused > 500);
}
