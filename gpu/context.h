#pragma once

// Inside gpu/ only: the state of one open context, and the one that is current on this thread.

#include <glad/gl.h>

#include <string>
#include <string_view>
#include <vector>

#include "gpu/bindings.h"
#include "gpu/device.h"
#include "gpu/egl.h"

namespace firn::gpu {

struct Context {
  explicit Context(const EglPlace& place);  // opens it, makes it current; throws DeviceError with the reason alone
  ~Context();                               // the context that was current before becomes current again
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  void make_current();
  void check();        // throws DriverError, or DeviceError where memory ran out
  void check_told() {  // the same without asking the driver: what it has told by itself, which costs no call
    if (!errors.empty()) check();
  }
  void forget_errors();  // those already told in another way
  void remember(std::string_view message);

  EglContext egl;
  Context* below = nullptr;  // current on this thread before this one
  DeviceInfo info;
  const char* label = "";
  std::vector<std::string> errors;  // of the driver, since the last check; the first few
  Bindings bindings;
  GLuint vertex_array = 0;  // empty: core profile draws nothing without one
  GLenum edit_unit = 0;     // the texture unit used for changes, beyond those of any shader stage
};

// Throws DeviceError where no device is open on this thread.
Context& current();
// For destructors: with the context gone its objects are gone, and there is nothing to delete.
Context* current_or_null() noexcept;

// As check(), where memory ran out with name and size of what was to be made.
void check_allocation(Context& context, std::string_view what, std::string_view label, std::uint64_t bytes);

// glObjectLabel, cut to the length that the driver takes.
void name_object(GLenum kind, GLuint id, std::string_view label);

// The formats of texels as OpenGL names them.
struct GlFormat {
  GLenum internal, format, type;
};
enum class TexelFormat;
GlFormat gl_format(TexelFormat format);

}  // namespace firn::gpu
