#include "gpu/egl.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "gpu/denormals.h"
#include "gpu/device.h"

namespace firn::gpu {

namespace {

constexpr EGLint drm_device_file = 0x3233;       // EGL_DRM_DEVICE_FILE_EXT (EGL_EXT_device_drm)
constexpr EGLint drm_render_node_file = 0x3377;  // EGL_DRM_RENDER_NODE_FILE_EXT (EGL_EXT_device_drm_render_node)
constexpr std::array khr_debug = {0x30FC, 0x1};  // EGL_CONTEXT_FLAGS_KHR, EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR (EGL_KHR_create_context)
constexpr EGLint offered_versions[][2] = {{4, 6}, {4, 5}, {4, 3}};

bool lists(const char* extensions, std::string_view name) {
  if (!extensions) return false;
  const std::string padded = fmt::format(" {} ", extensions);
  return padded.find(fmt::format(" {} ", name)) != std::string::npos;
}

std::string egl_error() {
  const EGLint error = eglGetError();
  switch (error) {
    case EGL_SUCCESS:
      return "no reason given";
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS:
      return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_DISPLAY:
      return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    default:
      return fmt::format("EGL error {:#06x}", error);
  }
}

std::string device_path(EGLDeviceEXT device, const char* extensions) {
  const char* path = nullptr;
  if (lists(extensions, "EGL_EXT_device_drm_render_node")) path = eglQueryDeviceStringEXT(device, drm_render_node_file);
  if (!path && lists(extensions, "EGL_EXT_device_drm")) path = eglQueryDeviceStringEXT(device, drm_device_file);
  return path ? path : "";
}

EGLContext create_context(EGLDisplay display, std::array<EGLint, 2> debug, EGLContext shared) {
  if (!eglBindAPI(EGL_OPENGL_API)) throw DeviceError("this EGL offers no OpenGL, only OpenGL ES");
  constexpr EGLint config_attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  const bool chosen = eglChooseConfig(display, config_attributes, &config, 1, &count) && count > 0;
  if (!chosen) config = nullptr;  // EGL_NO_CONFIG_KHR, which drivers without pbuffers know
  for (const auto& version : offered_versions) {
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 version[0],
                                 EGL_CONTEXT_MINOR_VERSION,
                                 version[1],
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 debug[0],
                                 debug[1],
                                 EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, shared, attributes);
    if (context != EGL_NO_CONTEXT) return context;
  }
  const std::string reason = egl_error();
  constexpr EGLint any_version[] = {EGL_NONE};
  const EGLContext context = eglCreateContext(display, config, shared, any_version);
  if (context == EGL_NO_CONTEXT) throw DeviceError(fmt::format("no OpenGL context could be created ({})", reason));
  return context;
}

}  // namespace

std::vector<EglPlace> egl_places() {
  if (!gladLoaderLoadEGL(nullptr)) {
    throw DeviceError("libEGL.so.1 cannot be loaded: install it (Debian and Ubuntu: libegl1) and the driver of the device");
  }
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::vector<EglPlace> places;
  if (!lists(client, "EGL_EXT_platform_base")) {
    throw DeviceError("this EGL has no EGL_EXT_platform_base, without which no device is reached: a newer libEGL is needed");
  }
  const bool enumerates = lists(client, "EGL_EXT_device_enumeration") || lists(client, "EGL_EXT_device_base");
  EGLint count = 0;
  if (enumerates && lists(client, "EGL_EXT_platform_device") && eglQueryDevicesEXT(0, nullptr, &count) && count > 0) {
    std::vector<EGLDeviceEXT> devices(count);
    if (!eglQueryDevicesEXT(count, devices.data(), &count)) count = 0;
    for (int index = 0; index < count; ++index) {
      const char* extensions = eglQueryDeviceStringEXT(devices[index], EGL_EXTENSIONS);
      const bool software = lists(extensions, "EGL_MESA_device_software");
      const std::string path = device_path(devices[index], extensions);
      const std::string detail = !path.empty() ? fmt::format(" ({})", path) : software ? " (software)" : "";
      places.push_back({fmt::format("EGL device {}{}", index, detail), EGL_PLATFORM_DEVICE_EXT, devices[index], software});
    }
  }
  if (lists(client, "EGL_MESA_platform_surfaceless")) {
    places.push_back({"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, false});
  }
  return places;
}

EglContext::EglContext(const EglPlace& place) {
  const DenormalsAsZero mode;  // a software renderer starts its threads here
  display_ = eglGetPlatformDisplayEXT(place.platform, place.native, nullptr);
  if (display_ == EGL_NO_DISPLAY) throw DeviceError(fmt::format("eglGetPlatformDisplay failed ({})", egl_error()));
  // Never terminated: EGL has one display per device and process and counts no users, so terminating it would take along the
  // contexts of others. It also keeps the driver loaded, which not every driver survives otherwise.
  EGLint major = 0, minor = 0;
  if (!eglInitialize(display_, &major, &minor)) throw DeviceError(fmt::format("eglInitialize failed ({})", egl_error()));
  // glad knows the functions beyond EGL 1.0 only once it sees an initialised display.
  const int version = gladLoaderLoadEGL(display_);
  const char* extensions = eglQueryString(display_, EGL_EXTENSIONS);
  const bool modern = version >= GLAD_MAKE_VERSION(1, 5);
  if (!modern && !lists(extensions, "EGL_KHR_create_context")) {
    throw DeviceError(
        fmt::format("EGL 1.5 or EGL_KHR_create_context is needed; offered is {}", eglQueryString(display_, EGL_VERSION)));
  }
  if (!lists(extensions, "EGL_KHR_surfaceless_context")) {
    throw DeviceError("EGL_KHR_surfaceless_context is needed (a context without a window) and not offered");
  }
  debug_ = modern ? std::array{EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE} : khr_debug;
  context_ = create_context(display_, debug_, EGL_NO_CONTEXT);
}

EglContext::EglContext(const EglContext* shared)
    : display_(shared->display_), debug_(shared->debug_), context_(create_context(display_, debug_, shared->context_)) {}

EglContext::~EglContext() {
  if (eglGetCurrentContext() == context_) release();
  eglDestroyContext(display_, context_);
}

bool EglContext::make_current() const {
  // The API is kept per thread, and a window library may have chosen another.
  return eglBindAPI(EGL_OPENGL_API) && eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
}

void EglContext::release() const { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

}  // namespace firn::gpu
