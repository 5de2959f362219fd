#include <string>

#include "config/node.h"
#include "config/parsed.h"
#include "tests/config/support.h"

using namespace firn::config;
using namespace firn::test;

namespace {

std::string where(const Place& place) { return to_string(place); }

}  // namespace

TEST_CASE("a document becomes a tree of maps, lists, texts and nothing, in the order of the file") {
  const Node root = parse_good("z: [1, two]\na: {b: null, c: ~}\nempty:\nlist: []\nmap: {}\n");
  REQUIRE(root.kind == Node::Kind::map);
  REQUIRE(root.entries.size() == 5);
  CHECK(root.entries[0].key == "z");
  CHECK(root.entries[1].key == "a");
  const Node* list = root.find("z");
  REQUIRE(list != nullptr);
  REQUIRE(list->items.size() == 2);
  CHECK(list->items[0].scalar == "1");
  CHECK(list->items[1].scalar == "two");
  CHECK(root.find("a")->find("b")->kind == Node::Kind::null);
  CHECK(root.find("a")->find("c")->kind == Node::Kind::null);
  CHECK(root.find("empty")->kind == Node::Kind::null);
  CHECK(root.find("list")->kind == Node::Kind::sequence);
  CHECK(root.find("map")->kind == Node::Kind::map);
  CHECK(root.find("absent") == nullptr);
  CHECK(list->find("z") == nullptr);
}

TEST_CASE("places count lines and columns from 1") {
  const Node root = parse_good("# snow\nmaterial:\n  density: 400\n  list: [1, {x: 2}]\n");
  CHECK(where(root.place) == "a.yaml:2:1");
  const Node& material = *root.find("material");
  CHECK(where(root.entries[0].place) == "a.yaml:2:1");
  CHECK(where(material.place) == "a.yaml:3:3");
  CHECK(where(material.entries[0].place) == "a.yaml:3:3");
  CHECK(where(material.find("density")->place) == "a.yaml:3:12");
  CHECK(where(material.find("list")->place) == "a.yaml:4:9");
  CHECK(where(material.find("list")->items[1].place) == "a.yaml:4:13");
  CHECK(where(material.find("list")->items[1].find("x")->place) == "a.yaml:4:17");
}

TEST_CASE("columns count characters, not bytes") {
  CHECK(where(parse_good("größe: 1").find("größe")->place) == "a.yaml:1:8");
  CHECK(where(parse_good("雪: [雪, 1]").find("雪")->items[1].place) == "a.yaml:1:8");
}

TEST_CASE("columns are right far out in long lines") {
  std::string text = "[";
  for (int i = 0; i < 500; ++i) text += "\"ß\", ";
  const Node root = parse_good("# ß\n" + text + "1]");
  for (int i = 0; i < 500; ++i) {
    if (where(root.items[i].place) != "a.yaml:2:" + std::to_string(2 + 5 * i)) FAIL(i);
  }
}

TEST_CASE("a byte order mark and any kind of line break leave the places as they are") {
  const Node root = parse_good(
      "\xEF\xBB\xBF"
      "a: 1\r\nb: 2\rc: 3\n");
  REQUIRE(root.entries.size() == 3);
  CHECK(where(root.find("a")->place) == "a.yaml:1:4");
  CHECK(where(root.find("b")->place) == "a.yaml:2:4");
  CHECK(where(root.find("c")->place) == "a.yaml:3:4");
}

TEST_CASE("a value that is not there has the place of its key") {
  const Node root = parse_good("a:\n\n# more\nb: 1\nc:\n");
  CHECK(where(root.find("a")->place) == "a.yaml:1:1");
  CHECK(where(root.find("c")->place) == "a.yaml:5:1");
  CHECK(parse_good("a: 1\nb:").find("b")->kind == Node::Kind::null);
  CHECK(parse_good("b: # later").find("b")->kind == Node::Kind::null);
}

TEST_CASE("quotes, block texts, texts of several lines and !!str are text, not numbers") {
  const Node root = parse_good("a: \"8\"\nb: '8'\nc: !!str 8\nd: |\n  8\ne: 8\nf: 8\n  9\ng: !!int 8\nh: ''\n");
  CHECK(root.find("a")->quoted);
  CHECK(root.find("b")->quoted);
  CHECK(root.find("c")->quoted);
  CHECK(root.find("d")->quoted);
  CHECK_FALSE(root.find("e")->quoted);
  CHECK(root.find("f")->scalar == "8 9");
  CHECK_FALSE(root.find("g")->quoted);
  CHECK(root.find("h")->kind == Node::Kind::scalar);
  CHECK(root.find("h")->quoted);
}

TEST_CASE("escapes in double quotes become characters in UTF-8") {
  CHECK(parse_good("\"\\t\\x41\\xe9\\u96ea\\U0001F328\"").scalar == "\tAé雪🌨");
  CHECK(parse_good("\"é\\_\\N\\L\"").scalar == "é\xC2\xA0\xC2\x85\xE2\x80\xA8");
  CHECK(parse_good("\"a\\0b\"").scalar == std::string("a\0b", 3));
}

TEST_CASE("an alias copies what its anchor names, places included") {
  const Node root = parse_good("a: &snow {density: 400}\nb: *snow\nc: [*snow, &n 5, *n]\n");
  REQUIRE(root.find("b")->kind == Node::Kind::map);
  CHECK(root.find("b")->find("density")->scalar == "400");
  CHECK(where(root.find("b")->find("density")->place) == "a.yaml:1:20");
  CHECK(root.find("c")->items[0].find("density")->scalar == "400");
  CHECK(root.find("c")->items[2].scalar == "5");
}

TEST_CASE("an anchor given again names the later value") {
  const Node root = parse_good("[&a 1, *a, &a 2, *a]");
  CHECK(root.items[1].scalar == "1");
  CHECK(root.items[3].scalar == "2");
}

TEST_CASE("a duplicate key is an error at the second key, with the line of the first") {
  CHECK(errors_of("a: 1\nb: 2\na: 3\n") == std::vector<std::string>{"a.yaml:3:1: error: duplicate key 'a': first given on line 1"});
  CHECK(errors_of("m: {a: 1, \"a\": 3}").size() == 1);
  CHECK(errors_of("m: {a: 1}\nn: {a: 1}\n").empty());
  CHECK(errors_of("x: &m {a: 1, a: 2}\ny: *m\nz: *m\n").size() == 1);
}

TEST_CASE("every duplicate key of a file is reported, and the first value stays") {
  Diagnostics diagnostics;
  const Node root = parse("a: 1\na: 2\nb: 3\nb: 4\na: 5\n", "a.yaml", diagnostics);
  CHECK(diagnostics.all().size() == 3);
  CHECK(root.entries.size() == 2);
  CHECK(root.find("a")->scalar == "1");
}

TEST_CASE("what stands above a syntax error is kept") {
  Diagnostics diagnostics;
  const Node root = parse("a: 1\nb: [2, 3\nc: 4\n", "a.yaml", diagnostics);
  CHECK(diagnostics.all().size() == 1);
  REQUIRE(root.find("a") != nullptr);
  CHECK(root.find("a")->scalar == "1");
}

TEST_CASE("one line that begins a document and one that ends it are allowed") {
  CHECK(parse_good("---\na: 1\n...\n").find("a")->scalar == "1");
  CHECK(parse_good("%YAML 1.2\n---\na: 1\n").find("a")->scalar == "1");
}

TEST_CASE("nesting up to 100 is read, 101 is an error") {
  const auto nested = [](int depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  CHECK(errors_of(nested(100)).empty());
  const auto errors = errors_of(nested(101));
  REQUIRE(errors.size() == 1);
  CHECK(errors[0] == "a.yaml:1:101: error: lists and maps are nested more than 100 deep");
}

TEST_CASE("aliases cannot nest deeper than text can") {
  std::string text = "a0: &a0 [" + std::string(58, '[') + std::string(58, ']') + "]\n";
  CHECK(errors_of(text + "b: " + std::string(40, '[') + "*a0" + std::string(40, ']') + "\n").empty());
  const auto errors = errors_of(text + "b: " + std::string(41, '[') + "*a0" + std::string(41, ']') + "\n");
  REQUIRE(errors.size() == 1);
  CHECK(contains(errors[0], "this alias nests lists and maps more than 100 deep"));
}

TEST_CASE("aliases that multiply are stopped") {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before;
    for (int k = 1; k < 10; ++k) text += ", " + before;
    text += "]\n";
  }
  const auto errors = errors_of(text);
  REQUIRE(errors.size() == 1);
  CHECK(contains(errors[0], "more than 200000 values and keys"));
}

TEST_CASE("aliases of a long text are stopped") {
  std::string text = "a: &a " + std::string(1 << 20, 'x') + "\nb: [*a";
  for (int i = 0; i < 100; ++i) text += ", *a";
  const auto errors = errors_of(text + "]\n");
  REQUIRE(errors.size() == 1);
  CHECK(contains(errors[0], "copy more than 64 MiB of text"));
}

TEST_CASE("a text with more than 200000 values is an error") {
  std::string text = "[";
  for (int i = 0; i < 199'999; ++i) text += "1,";
  CHECK(errors_of(text + "]").empty());
  CHECK(errors_of(text + "1]").size() == 1);
}

TEST_CASE("describe says what a value is in a few words on one line") {
  CHECK(describe(parse_good("[1]")) == "a list");
  CHECK(describe(parse_good("{a: 1}")) == "a map");
  CHECK(describe(parse_good("null")) == "nothing");
  CHECK(describe(parse_good("soft snow")) == "'soft snow'");
  CHECK(describe(parse_good("\"a\\nb\\tc\\x01\"")) == "'a\\nb\\tc\\x01'");
  CHECK(describe(parse_good(std::string(100, 'x'))) == "'" + std::string(40, 'x') + "...'");
}

TEST_CASE("where a text stops to be YAML is told, and what stands before it is there") {
  const auto parsed = [](const std::string& text) {
    Diagnostics diagnostics;
    Parsed result = parse_broken(text, "a.yaml", diagnostics);
    CHECK(result.broken_at.has_value() == diagnostics.has_errors());
    return result;
  };
  CHECK_FALSE(parsed("a: 1\nb: [2, 3]\n").broken_at.has_value());
  const Parsed indented = parsed("a: 1\nb: c: 2\n");
  CHECK(where(indented.broken_at.value()) == "a.yaml:2:5");
  CHECK(indented.root.find("a")->scalar == "1");
  CHECK(where(parsed("a: 1\nb: [2, {c: [3,\nd: 4\n").broken_at.value()) == "a.yaml:2:4");
  CHECK(where(parsed("a: 1\nb: \"2\nc: 3\n").broken_at.value()) == "a.yaml:2:4");
  Diagnostics of_keys;
  CHECK_FALSE(parse_broken("a: 1\na: 2\n", "a.yaml", of_keys).broken_at.has_value());
  CHECK(of_keys.has_errors());
}
