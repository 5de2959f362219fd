#include "tests/gpu/support.h"

using namespace firn::gpu;
using namespace firn::test;

namespace {

// About 10 ms on a software renderer.
Program busy(const Device& device) {
  return kernel(device, R"(
    layout(local_size_x = 64) in;
    layout(std430, binding = 0) buffer Data { float values[]; };
    void main() {
      float x = float(gl_GlobalInvocationID.x);
      for (int i = 0; i < 1000; ++i) x = sqrt(x + 1.5);
      values[gl_GlobalInvocationID.x] = x;
    })");
}

}  // namespace

TEST_CASE("a timer gives positive times, in order and with their tags") {
  const auto device = Device::open();
  const Buffer data(65536, "data");
  const Program program = busy(*device);
  use(program);
  bind_storage(0, data);
  dispatch(256, 1, 1);  // machine code is made at the first dispatch
  device->finish();

  TimerRing timers(8);
  CHECK(timers.collect(true).empty());
  for (std::int64_t tag = 10; tag < 13; ++tag) {
    timers.begin(tag);
    dispatch(256, 1, 1);
    timers.end();
  }
  const std::vector<TimerRing::Sample> samples = timers.collect(true);
  REQUIRE(samples.size() == 3);
  for (int i = 0; i < 3; ++i) {
    CAPTURE(i, samples[i].seconds);
    CHECK(samples[i].tag == 10 + i);
    CHECK(samples[i].seconds > 1e-7);
    CHECK(samples[i].seconds < 10);
  }
  CHECK(timers.collect(true).empty());
}

TEST_CASE("a full timer ring loses nothing") {
  const auto device = Device::open();
  const Buffer data(256, "data");
  const Program program = busy(*device);
  use(program);
  bind_storage(0, data);
  TimerRing timers(3);
  std::vector<std::int64_t> tags;
  for (std::int64_t tag = 0; tag < 20; ++tag) {
    timers.begin(tag);
    dispatch(1, 1, 1);
    timers.end();
    if (tag == 9) {
      for (const TimerRing::Sample& sample : timers.collect(false)) tags.push_back(sample.tag);
    }
  }
  for (const TimerRing::Sample& sample : timers.collect(true)) tags.push_back(sample.tag);
  REQUIRE(tags.size() == 20);
  for (std::int64_t tag = 0; tag < 20; ++tag) CHECK(tags[tag] == tag);
}

TEST_CASE("begin and end of a timer must alternate") {
  const auto device = Device::open();
  TimerRing timers(2);
  CHECK_THROWS_AS(timers.end(), std::logic_error);
  timers.begin(1);
  CHECK_THROWS_AS(timers.begin(2), std::logic_error);
  timers.end();
  CHECK(timers.collect(true).size() == 1);
}
