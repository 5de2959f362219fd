#pragma once

// Inside gpu/ only: EGL displays without a display server, and contexts on them.

#include <glad/egl.h>

#include <array>
#include <string>
#include <vector>

namespace firn::gpu {

// A place where a context can be opened: an EGL device, or Mesa's surfaceless platform.
struct EglPlace {
  std::string where;
  EGLenum platform = 0;
  void* native = nullptr;      // EGLDeviceEXT, or EGL_DEFAULT_DISPLAY
  bool says_software = false;  // EGL_MESA_device_software
};

// Devices in the driver's order, the surfaceless platform last. Throws DeviceError where EGL is missing.
std::vector<EglPlace> egl_places();

// An OpenGL core context without a surface. The OpenGL functions of glad are not loaded by it.
class EglContext {
 public:
  // Asks for 4.6, 4.5 and 4.3 with debug output, then for any core context, so that the caller can tell what is offered instead.
  // Throws DeviceError with the reason alone (the caller knows the place).
  explicit EglContext(const EglPlace& place);
  // A further one, which has the objects of `shared` too. For another thread: nothing of EGL or glad is initialised.
  explicit EglContext(const EglContext* shared);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  bool make_current() const;  // on the calling thread
  void release() const;       // leaves the calling thread without a context

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  std::array<EGLint, 2> debug_ = {};  // the attribute that asks for debug output, and its value
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace firn::gpu
