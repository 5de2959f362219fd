// Whole quotients by floats, as shaders/lib/divide.glsl has them.

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/catch.h"
#include "tests/stages/harness.h"

using namespace firn::test;

TEST_CASE("numbers up to 2^30 are divided exactly, also beside multiples and by one") {
  using namespace firn::graph;
  INFO("seed " << seed());
  std::mt19937_64 engine(seed());
  std::uniform_real_distribution<double> exponent(0, 30);
  constexpr int most = 1 << 30;
  const auto any = [&] { return static_cast<int>(std::exp2(exponent(engine))); };
  std::vector<std::int32_t> pairs;
  const auto add = [&](int number, int by) { pairs.insert(pairs.end(), {std::clamp(number, 0, most), by}); };
  for (int i = 0; i < 100000; ++i) {
    const int number = any(), by = any();
    add(number, by);
    for (const int off : {-1, 0, 1}) add(number / by * by + off, by);
    add(most - i, 1 + i % 7);
  }
  Registry registry;
  const auto port = [](const char* name, Access access) {
    return Port{.name = name, .type = ElementType::ivec2, .domain = "pairs", .access = access, .unit = "1", .doc = "of the test"};
  };
  registry.add({.name = "test.divide",
                .doc = "Quotients",
                .equation = "",
                .ports = {port("pair", Access::read), port("result", Access::write)},
                .work = {Dispatch{.kernel = std::string(FIRN_SOURCE_DIR) + "/tests/stages/shaders/divide.comp", .over = "pairs"}}});
  Environment environment;
  environment.domains["pairs"] = {pairs.size() / 2};
  environment.provided = {"pair", "result"};
  Arrays in;
  in.integers["pair"] = pairs;
  const Arrays out = run_pipeline("firn: 1\nstep: [test.divide]\n", environment, registry, in, 0, 1);
  const std::vector<std::int32_t>& result = out.integers.at("result");
  REQUIRE(result.size() == pairs.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < pairs.size(); i += 2) {
    if (result[i] == pairs[i] % pairs[i + 1] && result[i + 1] == pairs[i] / pairs[i + 1]) continue;
    if (wrong++ == 0) {
      CAPTURE(pairs[i], pairs[i + 1], result[i], result[i + 1]);
      CHECK(wrong == 0);
    }
  }
  CHECK(wrong == 0);
}
