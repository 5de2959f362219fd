#include "stages/writer.h"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <vector>

#include "tests/catch.h"

using firn::stages::Writer;

TEST_CASE("jobs are all done, in their order, also those that wait when the writer ends") {
  std::vector<int> done;
  {
    Writer writer(100);
    for (int i = 0; i < 50; ++i)
      writer.add(30, [&done, i] {
        if (i % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        done.push_back(i);
      });
  }
  REQUIRE(done.size() == 50);
  for (int i = 0; i < 50; ++i) CHECK(done[static_cast<std::size_t>(i)] == i);
}

TEST_CASE("no more bytes wait than are allowed, and a job larger than that goes alone") {
  std::atomic<int> held{0}, most{0};
  Writer writer(100);
  const auto add = [&](int bytes) {
    writer.add(static_cast<std::size_t>(bytes), [&, bytes] {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      held -= bytes;
    });
    held += bytes;  // a job may end before: the sum seen here is at most what waits
    most = std::max(most.load(), held.load());
  };
  for (int i = 0; i < 20; ++i) add(40);
  writer.finish();
  CHECK(most <= 100);
  CHECK(most >= 40);
  add(1000);
  add(10);
  writer.finish();
  CHECK(held == 0);
}

TEST_CASE("what a job throws is thrown by finish, and again, and later jobs are not run") {
  Writer writer;
  std::atomic<bool> later{false};
  writer.add(1, [] { throw std::runtime_error("the disk is full"); });
  for (int i = 0; i < 2; ++i) CHECK_THROWS_WITH(writer.finish(), "the disk is full");
  CHECK_THROWS_WITH(writer.add(1, [&] { later = true; }), "the disk is full");
  CHECK_FALSE(later);
}

TEST_CASE("what waits behind a job that fails is not run") {
  std::atomic<bool> later{false}, go_on{false};
  Writer writer;
  writer.add(1, [&] {
    while (!go_on) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    throw std::runtime_error("the disk is full");
  });
  writer.add(1, [&] { later = true; });
  go_on = true;
  CHECK_THROWS_WITH(writer.finish(), "the disk is full");
  CHECK_FALSE(later);
}
