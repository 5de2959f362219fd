#include "gpu/calls.h"

#include <regex>
#include <sstream>

#include "tests/gpu/support.h"

using namespace firn::gpu;
using namespace firn::test;
namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  std::string code;
  for (std::string line; std::getline(stream, line);) code += line.substr(0, line.find("//")) + "\n";
  return code;
}

}  // namespace

TEST_CASE("every function of OpenGL that is called is counted") {
  const std::string counted = text_of(std::string(FIRN_SOURCE_DIR) + "/gpu/calls.cpp");
  const std::regex call("\\b(gl[A-Z]\\w*)\\(");
  int found = 0;
  for (const auto& file : fs::directory_iterator(std::string(FIRN_SOURCE_DIR) + "/gpu")) {
    if (file.path().extension() != ".cpp" || file.path().filename() == "calls.cpp") continue;
    const std::string code = text_of(file.path());
    for (auto at = std::sregex_iterator(code.begin(), code.end(), call); at != std::sregex_iterator(); ++at, ++found) {
      INFO(file.path().filename().string() << " calls " << (*at)[1].str());
      CHECK(counted.find("COUNTED(" + (*at)[1].str() + ")") != std::string::npos);
    }
  }
  CHECK(found > 100);
}

TEST_CASE("calls are counted by name while the counter lives") {
  const auto device = Device::open();
  const Buffer buffer(64, "buffer");
  {
    const CallCounter counter;
    memory_barrier_all();
    memory_barrier_all();
    bind_storage(0, buffer);
    bind_storage(0, buffer);
    const auto calls = CallCounter::take();
    CHECK(calls == std::map<std::string, std::uint64_t>{{"glMemoryBarrier", 2}, {"glBindBufferBase", 1}});
    device->finish();
    CHECK(CallCounter::take().at("glFinish") == 1);
  }
  memory_barrier_all();
  const CallCounter again;
  CHECK(CallCounter::take().empty());
}

TEST_CASE("what asks the device or waits for it is a query") {
  for (const char* name : {"glGetError", "glGetIntegerv", "glGetBufferSubData", "glFinish", "glCheckFramebufferStatus"})
    CHECK(is_query(name));
  for (const char* name : {"glDispatchCompute", "glBindBuffer", "glBufferSubData", "glQueryCounter", "glGenBuffers"})
    CHECK_FALSE(is_query(name));
}

TEST_CASE("an upload, a draw and a check ask nothing of a driver that tells errors by itself") {
  const auto device = Device::open();
  const Texture color(4, 4, TexelFormat::rgba8, "color");
  const std::array colors = {&color};
  const Framebuffer target(colors, nullptr, "target");
  const std::array shaders = {
      std::pair{ShaderKind::vertex, with_version(*device, "void main() { gl_Position = vec4(0); }")},
      std::pair{ShaderKind::fragment, with_version(*device, "layout(location = 0) out vec4 c; void main() { c = vec4(1); }")}};
  const Program program(shaders, "program");
  Buffer buffer(64, "buffer");
  const std::array<std::byte, 16> data{};
  const CallCounter counter;
  for (int i = 0; i < 2; ++i) {
    CallCounter::take();
    buffer.upload(0, data);
    use(program);
    draw(target, {.topology = Topology::points}, 1, 1);
    device->check();
  }
  CHECK(CallCounter::take() == std::map<std::string, std::uint64_t>{{"glBufferSubData", 1}, {"glDrawArraysInstanced", 1}});
}
