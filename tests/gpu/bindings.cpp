#include "gpu/bindings.h"

#include <dlfcn.h>

#include "tests/gpu/support.h"

using namespace firn::gpu;
using namespace firn::test;

namespace {

const char* const adds_one = R"(
  layout(local_size_x = 1) in;
  layout(std430, binding = 0) buffer Data { uint value; };
  void main() { value += 1u; })";

}  // namespace

TEST_CASE("a binding that the driver refuses is not taken as made") {
  const auto device = Device::open();
  const Buffer buffer(64, "buffer");
  CHECK_THROWS_AS(bind_storage(1u << 20, buffer), DriverError);
  CHECK_THROWS_AS(bind_storage(1u << 20, buffer), DriverError);
  CHECK_THROWS_AS(bind_uniform(1u << 20, buffer), DriverError);
  const BufferTexture view(buffer, TexelFormat::r32f, "view");
  CHECK_THROWS_AS(bind_texture(1u << 20, view), DriverError);
  CHECK_THROWS_AS(bind_texture(1u << 20, view), DriverError);
  const Texture texture(4, 4, TexelFormat::r32f, "texture");
  CHECK_THROWS_AS(bind_image(1u << 20, texture), DriverError);
  CHECK_THROWS_AS(bind_image(1u << 20, texture), DriverError);
}

TEST_CASE("a new buffer with the id of a deleted one is bound anew", "[.same-ids]") {
  const auto device = Device::open();
  const Program program = kernel(*device, adds_one);
  use(program);
  std::uint32_t id = 0;
  {
    const Buffer first(16, "first");
    id = first.id();
    bind_storage(0, first);
    dispatch(1, 1, 1);
  }
  const Buffer second(16, "second");
  REQUIRE(second.id() == id);
  bind_storage(0, second);
  dispatch(1, 1, 1);
  CHECK(contents<std::uint32_t>(second)[0] == 1);
}

TEST_CASE("new uniforms, textures, images, targets, programs and commands with the ids of deleted ones are bound anew",
          "[.same-ids]") {
  const auto device = Device::open();
  const Buffer output(16, "output");
  bind_storage(0, output);
  const auto ran = [&](const std::string& text) {
    const Program program =
        kernel(*device, "layout(local_size_x = 1) in; layout(std430, binding = 0) buffer Output { uint value; };" + text);
    use(program);
    dispatch(1, 1, 1);
    memory_barrier_all();
    return contents<std::uint32_t>(output)[0];
  };

  for (std::uint32_t round = 1; round <= 3; ++round) {
    CAPTURE(round);
    CHECK(ran("void main() { value = " + std::to_string(round) + "u; }") == round);

    const Buffer data = buffer_of<std::uint32_t>({round, 0, 0, 0});
    bind_uniform(1, data);
    CHECK(ran("layout(std140, binding = 1) uniform Data { uint data; }; void main() { value = 10u + data; }") == 10 + round);

    const BufferTexture view(data, TexelFormat::r32ui, "view");
    bind_texture(2, view);
    CHECK(ran("layout(binding = 2) uniform usamplerBuffer data; void main() { value = 20u + texelFetch(data, 0).x; }") ==
          20 + round);

    Texture texture(1, 1, TexelFormat::r32ui, "texture");
    texture.upload(std::as_bytes(std::span(&round, 1)));
    bind_texture(2, texture);
    CHECK(ran("layout(binding = 2) uniform usampler2D data; void main() { value = 30u + texelFetch(data, ivec2(0), 0).x; }") ==
          30 + round);
    bind_image(3, texture);
    CHECK(ran("layout(r32ui, binding = 3) uniform uimage2D data; void main() { value = 40u + imageLoad(data, ivec2(0)).x; }") ==
          40 + round);

    const Texture* const colors[] = {&texture};
    const Framebuffer target(colors, nullptr, "target");
    clear_color(target, 0, 7, 0, 0, 0);
    CHECK(texels<std::uint32_t>(texture)[0] == 7);

    const Buffer groups = buffer_of<std::uint32_t>({round, 1, 1});
    bind_indirect(groups);
    ran("void main() { value = 0u; }");
    const Program counting = kernel(*device,
                                    "layout(local_size_x = 1) in; layout(std430, binding = 0) buffer Output { uint value; }; void "
                                    "main() { atomicAdd(value, 1u); }");
    use(counting);
    dispatch_indirect(0);
    CHECK(contents<std::uint32_t>(output)[0] == round);
  }
}

// Mesa counts names up unless it is told to use them again (by a variable that it renamed once), as other drivers do.
TEST_CASE("new objects with the ids of deleted ones are bound anew") {
  const std::string output = output_of_own_process("force_gl_names_reuse=true reuse_gl_names=true", "[.same-ids]");
  CAPTURE(output);
  CHECK(output.find("All tests passed") != std::string::npos);
}

TEST_CASE("what is deleted is forgotten at every point it was bound to, and nothing else is") {
  Bindings bindings;
  const auto points = [] { return std::vector<std::uint32_t>{7, 8, 7}; };
  bindings.storage = bindings.uniform = bindings.textures_2d = bindings.textures_buffer = bindings.images = points();
  bindings.indirect = bindings.program = bindings.framebuffer = 7;
  const std::vector<std::uint32_t> forgotten = {0, 8, 0};

  bindings.forget_buffer(7);
  CHECK(bindings.storage == forgotten);
  CHECK(bindings.uniform == forgotten);
  CHECK(bindings.indirect == 0);
  CHECK(bindings.textures_2d == points());

  bindings.forget_texture(7);
  CHECK(bindings.textures_2d == forgotten);
  CHECK(bindings.textures_buffer == forgotten);
  CHECK(bindings.images == forgotten);
  CHECK(bindings.program == 7);

  bindings.forget_program(7);
  CHECK(bindings.program == 0);
  CHECK(bindings.framebuffer == 7);
  bindings.forget_framebuffer(7);
  CHECK(bindings.framebuffer == 0);
}

TEST_CASE("a texture unit that the driver refuses leaves the others as they were") {
  const auto device = Device::open();
  const Buffer first = buffer_of<std::uint32_t>({1, 0, 0, 0}), second = buffer_of<std::uint32_t>({2, 0, 0, 0}),
               output(16, "output");
  const BufferTexture kept(first, TexelFormat::r32ui, "kept"), refused(second, TexelFormat::r32ui, "refused");
  const Program program = kernel(*device, R"(
    layout(local_size_x = 1) in;
    layout(binding = 2) uniform usamplerBuffer data;
    layout(std430, binding = 0) buffer Output { uint value; };
    void main() { value = texelFetch(data, 0).x; })");
  use(program);
  bind_storage(0, output);
  bind_texture(2, kept);
  CHECK_THROWS_AS(bind_texture(1u << 20, refused), DriverError);
  dispatch(1, 1, 1);
  CHECK(contents<std::uint32_t>(output)[0] == 1);
}

TEST_CASE("a deleted program runs no more") {
  const auto device = Device::open();
  const Buffer buffer(16, "buffer");
  bind_storage(0, buffer);
  use(kernel(*device, adds_one));
  CHECK_THROWS_AS(dispatch(1, 1, 1), DriverError);
}

TEST_CASE("bindings changed by others are made again once they are forgotten") {
  const auto device = Device::open();
  const Program program = kernel(*device, adds_one);
  const Buffer buffer(16, "buffer");
  const auto run = [&] {
    use(program);
    bind_storage(0, buffer);
    dispatch(1, 1, 1);
    memory_barrier_all();
  };
  run();
  void* const egl = dlopen("libEGL.so.1", RTLD_NOW);
  REQUIRE(egl);
  const auto address_of = reinterpret_cast<void (*(*)(const char*))()>(dlsym(egl, "eglGetProcAddress"));
  REQUIRE(address_of);
  reinterpret_cast<void (*)(unsigned)>(address_of("glUseProgram"))(0);
  CHECK_THROWS_AS(run(), DriverError);
  forget_bindings();
  run();
  CHECK(contents<std::uint32_t>(buffer)[0] == 2);
}
