#include <random>
#include <string>

#include "tests/config/support.h"

using namespace firn::config;
using namespace firn::test;

namespace {

Node text(std::string value, bool quoted) {
  Node node;
  node.kind = Node::Kind::scalar;
  node.scalar = std::move(value);
  node.quoted = quoted;
  return node;
}

class RandomTree {
 public:
  explicit RandomTree(std::uint64_t seed) : random_(seed) {}

  Node node(int depth) {
    Node result;
    switch (below(depth > 0 ? 6 : 3)) {
      case 0:
        return result;
      case 1:
        return text(plain(), false);
      case 2:
        return text(any(), true);
      case 3:
        result.kind = Node::Kind::sequence;
        for (std::size_t i = below(5); i > 0; --i) result.items.push_back(node(depth - 1));
        return result;
      default:
        result.kind = Node::Kind::map;
        for (std::size_t i = below(5); i > 0; --i) {
          const std::string key = below(2) == 0 ? plain() : any();
          if (result.find(key) == nullptr) result.entries.push_back({key, {}, node(depth - 1)});
        }
        return result;
    }
  }

 private:
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_() % count); }

  std::string plain() {
    constexpr std::array samples = {"8",   "-3.5e-4", "true", "soft snow", "a:b", "a#b", "-x",    "?x",      "größe", "雪",
                                    "a,b", "x]",      "yes",  "1 2",       "<<x", "=",   "a - b", "mpm.x_y", "it's",  "${k}"};
    return samples[below(samples.size())];
  }

  std::string any() {
    constexpr std::array samples = {
        "a", " ",  "\n",   "\t",   "\"",  "\\",  "'",  ":",  "#",    "- ",           "[",           "}",        ",", "&",
        "*", "!",  "|",    ">",    "%",   "@",   "`",  "~",  "null", "<<",           "?",           "\xC2\x85", "ß", "雪",
        "0", ".5", "\x01", "\x7F", "---", "...", "${", "\r", "e",    "\xE2\x80\xA8", "\xEF\xBB\xBF"};
    std::string result;
    const std::size_t length = below(20) == 0 ? 600 : below(6);
    for (std::size_t i = 0; i < length; ++i) result += samples[below(samples.size())];
    return result;
  }

  std::mt19937_64 random_;
};

}  // namespace

TEST_CASE("a random tree is the same after writing and reading") {
  INFO("seed " << seed());
  RandomTree random(seed());
  for (int round = 0; round < 1500; ++round) {
    const Node node = random.node(5);
    const std::string written = to_yaml(node);
    CAPTURE(written);
    if (!same(parse_good(written), node)) FAIL("not the same");
  }
}

TEST_CASE("the text is in block style, plain where it may be") {
  CHECK(to_yaml(parse_good("{a: [1, '2', {b: c}], d: {}, e: [], f: ~}")) ==
        "a:\n  - 1\n  - \"2\"\n  -\n    b: c\nd: {}\ne: []\nf: null\n");
  CHECK(to_yaml(parse_good("5")) == "5\n");
  CHECK(to_yaml(Node{}) == "null\n");
}

TEST_CASE("a text that YAML would take for something else gets quotes") {
  for (const char* value :
       {"",   " a", "a ", "null", "~",   "a: b", "a #b", "- a", "?",   "-",     "a:",  "#a", "[a",   "{a", "&a", "*a",
        "!a", "|",  ">",  "'a",   "\"a", "%a",   "@a",   "`a",  "---", "--- a", "...", ",a", "a\nb", "]",  "}"}) {
    CAPTURE(value);
    const Node back = parse_good(to_yaml(text(value, false)));
    CHECK(back.kind == Node::Kind::scalar);
    CHECK(back.scalar == value);
    CHECK(back.quoted);
  }
}
