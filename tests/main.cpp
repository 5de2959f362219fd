#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
#else
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#endif

// Catch2 2 returns the number of failures, which may be 77: the status that ctest takes for "skipped".
int main(int argc, char** argv) {
  const int failures = Catch::Session().run(argc, argv);
  return failures == 0 ? 0 : 1;
}
