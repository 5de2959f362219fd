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
  // One more on the same device, for a thread without one: it shares the objects of `shared`, which must outlive it.
  explicit Context(const Context* shared);
  ~Context();  // the context that was current before becomes current again
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  void make_current();  // and loads the functions of OpenGL
  void check();         // throws DriverError, or DeviceError where memory ran out
  void check_told() {   // the same without asking the driver: what it has told by itself, which costs no call
    if (!errors.empty()) check();
  }
  void check_quickly() {  // as check(), but asks the driver only if it is one that does not tell by itself
    if (!errors.empty() || !tells_errors) check();
  }
  void forget_errors();  // those already told in another way
  void remember(std::string_view message);

  EglContext egl;
  Context* below = nullptr;  // current on this thread before this one
  DeviceInfo info;
  const char* label = "";
  std::vector<std::string> errors;  // of the driver, since the last check; the first few
  bool tells_errors = false;        // whether the driver does tell
  Bindings bindings;
  GLuint vertex_array = 0;  // empty: core profile draws nothing without one
  GLenum edit_unit = 0;     // the texture unit used for changes, beyond those of any shader stage

 private:
  void set_up();
};

// Throws DeviceError where no device is open on this thread.
Context& current();
// For destructors: with the context gone its objects are gone, and there is nothing to delete.
Context* current_or_null() noexcept;

// Changes of buffers go through a binding point that nothing else uses, as direct state access is OpenGL 4.5.
constexpr GLenum edit_point = GL_COPY_WRITE_BUFFER;
void bind_edited(Context& context, GLuint buffer);

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
