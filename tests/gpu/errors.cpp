#include "tests/gpu/support.h"

using namespace firn::gpu;
using namespace firn::test;

namespace {

const char* const adds_one = R"(
  layout(local_size_x = 1) in;
  layout(std430, binding = 0) buffer Data { uint value; };
  void main() { value += 1u; })";

}  // namespace

TEST_CASE("an error of the driver carries the label of the work, once") {
  const auto device = Device::open();
  device->label("mpm.particles_to_grid");
  const Buffer buffer(64, "buffer");
  const Program program = kernel(*device, adds_one);
  use(program);
  bind_storage(0, buffer);
  const std::string message = message_of<DriverError>([] { dispatch(0xffffffffu, 1, 1); });
  contains(message, "'mpm.particles_to_grid'");
  contains(message, "GL_INVALID_VALUE");
  CHECK_NOTHROW(device->check());
  CHECK_NOTHROW(dispatch(1, 1, 1));

  device->label("mpm.clear_grid");
  std::vector<std::byte> bytes(65);
  contains(message_of<DriverError>([&] { buffer.download(0, bytes); }), "'mpm.clear_grid'");
  device->label(nullptr);
  const std::string unlabelled = message_of<DriverError>([] { bind_storage(0xfffffff0u, Buffer(16, "small")); });
  CHECK(unlabelled.find("while running") == std::string::npos);
  CHECK_NOTHROW(device->check());
}

TEST_CASE("memory that the device cannot give is a device error with name and size") {
  const auto device = Device::open();
  const std::string buffer = message_of<DeviceError>([] { Buffer(std::uint64_t{1} << 50, "grid mass"); });
  contains(buffer, "'grid mass'");
  contains(buffer, std::to_string(std::uint64_t{1} << 50));
  const int size = device->info().limits.texture_size + 1;
  const std::string texture = message_of<DeviceError>([&] { Texture(size, 1, TexelFormat::r32f, "depth map"); });
  contains(texture, "'depth map'");
  contains(texture, std::to_string(size));
  CHECK_THROWS_AS(Texture(0, 4, TexelFormat::r32f, "none"), std::invalid_argument);
  CHECK_NOTHROW(device->check());
  CHECK_NOTHROW(Buffer(64, "small"));
}

TEST_CASE("a buffer texture beyond the device's limit is a device error, as OpenGL would cut it in silence") {
  const auto device = Device::open();
  const std::uint64_t most = device->info().limits.texture_buffer_texels;
  if (most > (std::uint64_t{1} << 28)) return;  // more memory than a test should take
  const Buffer large(4 * (most + 1), "large");
  contains(message_of<DeviceError>([&] { BufferTexture(large, TexelFormat::r32f, "view of it"); }), "'view of it'");
  CHECK_NOTHROW(BufferTexture(large, TexelFormat::rg32f, "view of pairs"));
}
