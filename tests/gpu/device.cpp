#include "gpu/device.h"

#include <cstdio>
#include <string>

#include "tests/gpu/support.h"

using namespace firn::gpu;
using namespace firn::test;

TEST_CASE("a device opens without a display and says what it is") {
  const auto device = Device::open();
  const DeviceInfo& info = device->info();
  CAPTURE(info.name, info.vendor, info.version);
  CHECK_FALSE(info.name.empty());
  CHECK_FALSE(info.version.empty());
  CHECK(info.major * 10 + info.minor >= 43);
  CHECK(device->version_directive() == "#version " + std::to_string(info.major) + std::to_string(info.minor) + "0 core");
  CHECK_FALSE(device->has("GL_FIRN_no_such_extension"));
  REQUIRE_FALSE(info.extensions.empty());
  CHECK(device->has(*info.extensions.begin()));
  device->finish();
}

TEST_CASE("the limits are at least those that OpenGL 4.3 promises") {
  const auto device = Device::open();
  const Limits& limits = device->info().limits;
  CHECK(limits.storage_blocks_compute >= 8);
  CHECK(limits.storage_bindings >= 8);
  CHECK(limits.storage_block_bytes >= 1u << 24);
  CHECK(limits.storage_offset_alignment >= 1);
  CHECK(limits.storage_offset_alignment <= 256);
  CHECK(limits.uniform_blocks_compute >= 12);
  CHECK(limits.uniform_block_bytes >= 16384);
  CHECK(limits.texture_units_compute >= 16);
  CHECK(limits.texture_buffer_texels >= 65536);
  CHECK(limits.texture_size >= 16384);
  for (const std::uint32_t groups : limits.groups) CHECK(groups >= 65535);
  CHECK(limits.group_invocations >= 1024);
  CHECK(limits.shared_bytes >= 32768);
}

TEST_CASE("every candidate works or has a problem, and opens by its index") {
  const std::vector<Device::Candidate> candidates = Device::candidates();
  REQUIRE_FALSE(candidates.empty());
  for (std::size_t index = 0; index < candidates.size(); ++index) {
    CAPTURE(index, candidates[index].where, candidates[index].problem);
    CHECK_FALSE(candidates[index].where.empty());
    CHECK(candidates[index].problem.empty() != candidates[index].info.name.empty());
    if (candidates[index].problem.empty()) {
      CHECK(Device::open(std::to_string(index))->info().name == candidates[index].info.name);
    } else {
      CHECK_THROWS_AS(Device::open(std::to_string(index)), DeviceError);
    }
  }
}

TEST_CASE("a device is chosen by kind or by a part of its name, in any case of letters") {
  bool any_hardware = false, any_software = false;
  for (const Device::Candidate& candidate : Device::candidates()) {
    if (!candidate.problem.empty()) continue;
    (candidate.info.software ? any_software : any_hardware) = true;
    CHECK(Device::open(candidate.info.name)->info().name == candidate.info.name);
  }
  CHECK(Device::open("auto")->info().software == !any_hardware);
  if (any_software) {
    const auto device = Device::open("software");
    CHECK(device->info().software);
    std::string upper = device->info().name.substr(0, 5);
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    CHECK(Device::open(upper)->info().name.substr(0, 5) == device->info().name.substr(0, 5));
  } else {
    CHECK_THROWS_AS(Device::open("software"), DeviceError);
  }
  if (any_hardware) {
    CHECK_FALSE(Device::open("hardware")->info().software);
  } else {
    CHECK_THROWS_AS(Device::open("hardware"), DeviceError);
  }
}

TEST_CASE("a device that is not there is an error that tells what there is") {
  const std::string by_name = message_of<DeviceError>([] { Device::open("abacus"); });
  contains(by_name, "'abacus'");
  for (const Device::Candidate& candidate : Device::candidates()) contains(by_name, candidate.where);

  const std::string by_index = message_of<DeviceError>([] { Device::open("4711"); });
  contains(by_index, "4711");
  for (const Device::Candidate& candidate : Device::candidates()) contains(by_index, candidate.where);
}

TEST_CASE("looking at the candidates leaves the open device as it was") {
  const auto device = Device::open();
  const Buffer buffer = buffer_of<int>({1, 2, 3, 4});
  Device::candidates();
  CHECK(contents<int>(buffer) == std::vector{1, 2, 3, 4});
  device->check();
}

TEST_CASE("devices may be closed in any order, and the one opened before is current again") {
  auto first = Device::open();
  const Buffer buffer = buffer_of<int>({1, 2, 3, 4});
  auto second = Device::open();
  auto third = Device::open();
  second.reset();
  third.reset();
  CHECK(contents<int>(buffer) == std::vector{1, 2, 3, 4});
}

TEST_CASE("objects may be destroyed after their device, and nothing is made without one") {
  auto device = Device::open();
  {
    const Buffer buffer(64, "buffer");
    const BufferTexture view(buffer, TexelFormat::r32f, "view");
    const Texture texture(4, 4, TexelFormat::rgba8, "texture");
    const Texture* const colors[] = {&texture};
    const Framebuffer target(colors, nullptr, "target");
    const Program program = kernel(*device, "layout(local_size_x = 1) in; void main() {}");
    const TimerRing timers(2);
    device.reset();
  }
  CHECK_THROWS_AS(Buffer(64, "buffer"), DeviceError);
  CHECK_THROWS_AS(dispatch(1, 1, 1), DeviceError);
}

// Run by the test below in a process of its own, as Mesa reads the variable once.
TEST_CASE("the device is too old", "[.too-old]") {
  std::printf("%s\n", message_of<DeviceError>([] { Device::open(); }).c_str());
  for (const Device::Candidate& candidate : Device::candidates()) std::printf("%s\n", candidate.problem.c_str());
}

TEST_CASE("a device below OpenGL 4.3 is an error that names it and its version") {
  const std::string name = Device::open()->info().name;
  if (Device::open()->info().version.find("Mesa") == std::string::npos) return;  // only Mesa can pretend
  const std::string output = output_of_own_process("MESA_GL_VERSION_OVERRIDE=4.2", "[.too-old]");
  contains(output, "OpenGL 4.3 is needed; " + name + " offers 4.2\n");
}
