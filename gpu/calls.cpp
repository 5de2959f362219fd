#include "gpu/calls.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <string_view>
#include <type_traits>

namespace firn::gpu {

namespace {

// Stands in for the function that a variable of glad points to.
template <auto slot, typename Function>
struct Counted;
template <auto slot, typename Result, typename... Arguments>
struct Counted<slot, Result(GLAD_API_PTR*)(Arguments...)> {
  static inline Result(GLAD_API_PTR* original)(Arguments...) = nullptr;
  static inline std::atomic<std::uint64_t> calls{0};

  static Result GLAD_API_PTR call(Arguments... arguments) {
    calls.fetch_add(1, std::memory_order_relaxed);
    return original(arguments...);
  }
  static void begin() {
    original = *slot;
    if (original) *slot = call;  // else the device has not got it
    calls = 0;
  }
  static void end() { *slot = original; }
  static std::uint64_t take() { return calls.exchange(0); }
};

struct Counting {
  const char* name;
  void (*begin)();
  void (*end)();
  std::uint64_t (*take)();
};

template <auto slot>
constexpr Counting counted(const char* name) {
  using Function = Counted<slot, std::remove_pointer_t<decltype(slot)>>;
  return {name, Function::begin, Function::end, Function::take};
}
#define COUNTED(function) counted<&glad_##function>(#function)

// Every function that this room calls; a test holds the list to its sources.
const std::array all = {COUNTED(glActiveTexture),
                        COUNTED(glAttachShader),
                        COUNTED(glBindBuffer),
                        COUNTED(glBindBufferBase),
                        COUNTED(glBindFramebuffer),
                        COUNTED(glBindImageTexture),
                        COUNTED(glBindTexture),
                        COUNTED(glBindTextureUnit),
                        COUNTED(glBindVertexArray),
                        COUNTED(glBlendEquation),
                        COUNTED(glBlendFunc),
                        COUNTED(glBlendFuncSeparate),
                        COUNTED(glBufferData),
                        COUNTED(glBufferSubData),
                        COUNTED(glCheckFramebufferStatus),
                        COUNTED(glClearBufferData),
                        COUNTED(glClearBufferfv),
                        COUNTED(glClearBufferiv),
                        COUNTED(glClearBufferuiv),
                        COUNTED(glCompileShader),
                        COUNTED(glCopyBufferSubData),
                        COUNTED(glCreateProgram),
                        COUNTED(glCreateShader),
                        COUNTED(glCullFace),
                        COUNTED(glDebugMessageCallback),
                        COUNTED(glDebugMessageControl),
                        COUNTED(glDeleteBuffers),
                        COUNTED(glDeleteFramebuffers),
                        COUNTED(glDeleteProgram),
                        COUNTED(glDeleteQueries),
                        COUNTED(glDeleteShader),
                        COUNTED(glDeleteTextures),
                        COUNTED(glDepthFunc),
                        COUNTED(glDepthMask),
                        COUNTED(glDetachShader),
                        COUNTED(glDisable),
                        COUNTED(glDispatchCompute),
                        COUNTED(glDispatchComputeIndirect),
                        COUNTED(glDrawArraysInstanced),
                        COUNTED(glDrawBuffers),
                        COUNTED(glEnable),
                        COUNTED(glFinish),
                        COUNTED(glFramebufferTexture2D),
                        COUNTED(glGenBuffers),
                        COUNTED(glGenFramebuffers),
                        COUNTED(glGenQueries),
                        COUNTED(glGenTextures),
                        COUNTED(glGenVertexArrays),
                        COUNTED(glGetBufferSubData),
                        COUNTED(glGetError),
                        COUNTED(glGetInteger64v),
                        COUNTED(glGetIntegeri_v),
                        COUNTED(glGetIntegerv),
                        COUNTED(glGetProgramBinary),
                        COUNTED(glGetProgramInfoLog),
                        COUNTED(glGetProgramiv),
                        COUNTED(glGetQueryObjectiv),
                        COUNTED(glGetQueryObjectui64v),
                        COUNTED(glGetQueryiv),
                        COUNTED(glGetShaderInfoLog),
                        COUNTED(glGetShaderiv),
                        COUNTED(glGetString),
                        COUNTED(glGetStringi),
                        COUNTED(glGetTexImage),
                        COUNTED(glLinkProgram),
                        COUNTED(glMaxShaderCompilerThreadsKHR),
                        COUNTED(glMemoryBarrier),
                        COUNTED(glObjectLabel),
                        COUNTED(glPatchParameteri),
                        COUNTED(glPolygonMode),
                        COUNTED(glProgramBinary),
                        COUNTED(glProgramParameteri),
                        COUNTED(glQueryCounter),
                        COUNTED(glScissor),
                        COUNTED(glShaderSource),
                        COUNTED(glTexBuffer),
                        COUNTED(glTexBufferRange),
                        COUNTED(glTexParameteri),
                        COUNTED(glTexStorage2D),
                        COUNTED(glTexSubImage2D),
                        COUNTED(glUseProgram),
                        COUNTED(glViewport)};

}  // namespace

CallCounter::CallCounter() {
  for (const Counting& one : all) one.begin();
}

CallCounter::~CallCounter() {
  for (const Counting& one : all) one.end();
}

std::map<std::string, std::uint64_t> CallCounter::take() {
  std::map<std::string, std::uint64_t> calls;
  for (const Counting& one : all)
    if (const std::uint64_t count = one.take()) calls[one.name] = count;
  return calls;
}

bool is_query(const std::string& call) {
  constexpr std::array asking = {"glGet", "glIs", "glCheck", "glFinish", "glRead", "glMap", "glClientWait"};
  return std::any_of(asking.begin(), asking.end(), [&](std::string_view beginning) { return call.starts_with(beginning); });
}

}  // namespace firn::gpu
