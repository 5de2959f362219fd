#include <algorithm>
#include <limits>
#include <numeric>

#include "tests/gpu/support.h"

using namespace firn::gpu;
using namespace firn::test;

namespace {

std::vector<float> random_values(std::size_t count) {
  std::mt19937_64 generator(seed());
  std::uniform_real_distribution<float> distribution(-1e3f, 1e3f);
  std::vector<float> values(count);
  for (float& value : values) value = distribution(generator);
  return values;
}

}  // namespace

TEST_CASE("a new buffer is zero and knows its size, nothing becomes 16 bytes") {
  const auto device = Device::open();
  const std::uint64_t bytes = GENERATE(1, 3, 4, 16, 1000, 1 << 20);
  const Buffer buffer(bytes, "zeros");
  CHECK(buffer.bytes() == bytes);
  CHECK(contents<std::uint8_t>(buffer) == std::vector<std::uint8_t>(bytes, 0));
  CHECK(Buffer(0, "nothing").bytes() == 16);
}

// Memory fresh from the system is zero by itself: it must have been used before. llvmpipe zeroes all by itself, softpipe and GPUs
// do not.
TEST_CASE("what is made in memory that was used before is zero too") {
  const auto device = Device::open();
  for (int round = 0; round < 20; ++round) {
    Buffer buffer(1000, "buffer");
    REQUIRE(contents<std::uint8_t>(buffer) == std::vector<std::uint8_t>(1000, 0));
    fill(buffer, std::vector<std::uint8_t>(1000, 0xab));
    Texture texture(10, 10, TexelFormat::rgba32f, "texture");
    REQUIRE(texels<float>(texture) == std::vector<float>(400, 0));
    const std::vector<float> ones(400, 1);
    texture.upload(std::as_bytes(std::span(ones)));
  }
}

TEST_CASE("a buffer gives back what was put in, whole or in part, and is zero once cleared") {
  const auto device = Device::open();
  INFO("seed " << seed());
  const std::vector<float> values = random_values(1001);
  Buffer buffer = buffer_of(values);
  CHECK(contents<float>(buffer) == values);

  const std::vector<float> part = {5, 6, 7};
  buffer.upload(40, std::as_bytes(std::span(part)));
  std::vector<float> read(5);
  buffer.download(36, std::as_writable_bytes(std::span(read)));
  CHECK(read == std::vector<float>{values[9], 5, 6, 7, values[13]});

  buffer.clear();
  CHECK(contents<float>(buffer) == std::vector<float>(1001, 0));
}

TEST_CASE("a moved buffer keeps its object and leaves nothing behind") {
  const auto device = Device::open();
  Buffer first = buffer_of<int>({1, 2, 3});
  Buffer second = std::move(first);
  CHECK(first.id() == 0);  // NOLINT(bugprone-use-after-move): that is the promise
  CHECK(contents<int>(second) == std::vector{1, 2, 3});
  second = buffer_of<int>({4, 5});
  CHECK(contents<int>(second) == std::vector{4, 5});
}

TEST_CASE("a kernel reads one storage buffer and writes another") {
  const auto device = Device::open();
  INFO("seed " << seed());
  const std::vector<float> values = random_values(1000);
  const Buffer input = buffer_of(values);
  const Buffer output(input.bytes(), "output");
  const Program program = kernel(*device, R"(
    layout(local_size_x = 64) in;
    layout(std430, binding = 0) readonly buffer Input { float values[]; };
    layout(std430, binding = 3) writeonly buffer Output { float doubled[]; };
    void main() {
      uint i = gl_GlobalInvocationID.x;
      if (i < values.length()) doubled[i] = 2.0 * values[i];
    })");
  use(program);
  bind_storage(0, input);
  bind_storage(3, output);
  dispatch(16, 1, 1);
  std::vector<float> expected = values;
  for (float& value : expected) value *= 2;
  CHECK(contents<float>(output) == expected);
}

#if defined(__SSE2__)
// Operations on denormals take processors some 150 cycles; GPUs have them as zero by themselves.
TEST_CASE("kernels of llvmpipe take denormals as zero, and the thread that opened the device keeps them") {
  const auto device = Device::open();
  volatile float small = 1e-30f;
  CHECK(small * 1e-10f > 0);
  if (device->info().name.find("llvmpipe") == std::string::npos) return;
  Buffer values = buffer_of<float>({1e-30f, 1e-10f, 1e-40f, 1e10f});
  const Program program = kernel(*device, R"(
    layout(local_size_x = 1) in;
    layout(std430, binding = 0) buffer Values { float values[4]; };
    void main() { values[1] *= values[0]; values[3] *= values[2]; })");
  use(program);
  bind_storage(0, values);
  dispatch(1, 1, 1);
  const std::vector<float> after = contents<float>(values);
  CHECK(after[1] == 0);
  CHECK(after[3] == 0);
}
#endif

TEST_CASE("a kernel reads uniforms, a buffer texture and a texture") {
  const auto device = Device::open();
  const Buffer parameters = buffer_of<float>({10, 100, 1000, 0});
  const Buffer data = buffer_of<float>({1, 2, 3, 4, 5, 6, 7, 8});
  const BufferTexture view(data, TexelFormat::rgba32f, "view");
  Texture texture(2, 2, TexelFormat::r32i, "texture");
  const std::vector<std::int32_t> quadrants = {1, 2, 3, -4};
  texture.upload(std::as_bytes(std::span(quadrants)));
  const Buffer output(16, "output");
  const Program program = kernel(*device, R"(
    layout(local_size_x = 1) in;
    layout(std140, binding = 2) uniform Parameters { vec3 weights; };
    layout(binding = 5) uniform samplerBuffer data;
    layout(binding = 6) uniform isampler2D field;
    layout(std430, binding = 0) buffer Output { float result[4]; };
    void main() {
      result[0] = weights.z;
      result[1] = texelFetch(data, 1).y * weights.x;
      result[2] = float(texelFetch(field, ivec2(0, 1), 0).x);
      result[3] = float(texture(field, vec2(7.0)).x);  // clamped to the edge
    })");
  use(program);
  bind_uniform(2, parameters);
  bind_texture(5, view);
  bind_texture(6, texture);
  bind_storage(0, output);
  dispatch(1, 1, 1);
  CHECK(contents<float>(output) == std::vector<float>{1000, 60, 3, -4});
}

TEST_CASE("a kernel writes and reads an image") {
  const auto device = Device::open();
  const Texture image(4, 2, TexelFormat::r32ui, "image");
  const Program program = kernel(*device, R"(
    layout(local_size_x = 4, local_size_y = 2) in;
    layout(r32ui, binding = 1) uniform uimage2D image;
    void main() {
      ivec2 at = ivec2(gl_GlobalInvocationID.xy);
      imageStore(image, at, uvec4(imageLoad(image, at).x + 10u * uint(at.y) + uint(at.x)));
    })");
  use(program);
  bind_image(1, image);
  dispatch(1, 1, 1);
  memory_barrier(static_cast<std::uint32_t>(BarrierBit::shader_image_access));
  dispatch(1, 1, 1);
  CHECK(texels<std::uint32_t>(image) == std::vector<std::uint32_t>{0, 2, 4, 6, 20, 22, 24, 26});
}

TEST_CASE("a kernel makes the group count of the next dispatch") {
  const auto device = Device::open();
  const Buffer groups(32, "groups"), count(4, "count");
  const Program writer = kernel(*device, R"(
    layout(local_size_x = 1) in;
    layout(std430, binding = 0) buffer Groups { uint groups[]; };
    void main() { groups[4] = 3u; groups[5] = 5u; groups[6] = 7u; })");
  const Program counter = kernel(*device, R"(
    layout(local_size_x = 1) in;
    layout(std430, binding = 0) buffer Count { uint count; };
    void main() { atomicAdd(count, 1u); })");
  use(writer);
  bind_storage(0, groups);
  dispatch(1, 1, 1);
  memory_barrier(static_cast<std::uint32_t>(BarrierBit::command));
  use(counter);
  bind_storage(0, count);
  bind_indirect(groups);
  dispatch_indirect(16);
  CHECK(contents<std::uint32_t>(count) == std::vector<std::uint32_t>{105});
}

TEST_CASE("barriers of every kind are accepted") {
  const auto device = Device::open();
  for (std::uint32_t bit = 0; bit < 11; ++bit) memory_barrier(1u << bit);
  memory_barrier(0);
  memory_barrier_all();
  CHECK_NOTHROW(device->check());
}

TEST_CASE("a texture is zero at first and gives back what was put in") {
  const auto device = Device::open();
  const TexelFormat format = GENERATE(TexelFormat::r32f, TexelFormat::rg32f, TexelFormat::rgba32f, TexelFormat::r32i,
                                      TexelFormat::rg32i, TexelFormat::rgba32i, TexelFormat::r32ui, TexelFormat::rg32ui,
                                      TexelFormat::rgba32ui, TexelFormat::rgba8, TexelFormat::depth32f);
  Texture texture(5, 3, format, "texture");
  const std::size_t numbers = 15 * static_cast<std::size_t>(bytes_per_texel(format)) / 4;
  CHECK(texels<std::uint32_t>(texture) == std::vector<std::uint32_t>(numbers, 0));
  std::vector<float> values(numbers);  // floats from 0 to 1 are exact in every format, seen as bits
  for (std::size_t i = 0; i < numbers; ++i) values[i] = static_cast<float>(i) / static_cast<float>(numbers);
  texture.upload(std::as_bytes(std::span(values)));
  CHECK(texels<float>(texture) == values);
  CHECK_THROWS_AS(texture.upload(std::as_bytes(std::span(values).subspan(1))), std::invalid_argument);
}

TEST_CASE("a texture too large for the band that zeroes it is zero all over") {
  const auto device = Device::open();
  for (int round = 0; round < 3; ++round) {
    Texture texture(1024, 700, TexelFormat::rgba32f, "large");  // 11 MiB
    std::vector<float> values = texels<float>(texture);
    CHECK(std::all_of(values.begin(), values.end(), [](float value) { return value == 0; }));
    std::fill(values.begin(), values.end(), 1.0f);
    texture.upload(std::as_bytes(std::span(values)));
  }
}
