#include "gpu/context.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace firn::gpu {

namespace {

constexpr std::size_t errors_kept = 8;

// Raw pointers: they need no destruction, so a Device may still be closed while the thread's own objects are destroyed.
thread_local Context* current_context = nullptr;

// Runs inside the driver, called from C: must not throw.
void GLAD_API_PTR on_debug_message(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* message,
                                   const void* user) {
  const bool undefined = type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR && severity == GL_DEBUG_SEVERITY_HIGH;
  if (type != GL_DEBUG_TYPE_ERROR && !undefined) return;
  if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;  // told by ShaderError
  try {
    auto* context = static_cast<Context*>(const_cast<void*>(user));
    context->remember(length < 0 ? std::string_view(message) : std::string_view(message, length));
  } catch (...) {
    // Without memory for the text the error is still in glGetError's flag, which check() reads.
  }
}

const char* error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST:
      return "GL_CONTEXT_LOST (the device was reset)";
    default:
      return "an unknown error";
  }
}

std::string text(GLenum name) {
  const auto* value = reinterpret_cast<const char*>(glGetString(name));
  return value ? value : "";
}

std::uint64_t number(GLenum name) {
  GLint64 value = 0;
  glGetInteger64v(name, &value);
  return value > 0 ? static_cast<std::uint64_t>(value) : 0;
}
int small_number(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

bool is_software(std::string renderer) {
  std::transform(renderer.begin(), renderer.end(), renderer.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array names = {"llvmpipe", "softpipe", "swrast", "software rasterizer", "swr (", "lavapipe", "swiftshader"};
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

Limits read_limits() {
  Limits limits;
  limits.storage_blocks_compute = small_number(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS);
  limits.storage_bindings = small_number(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
  limits.storage_block_bytes = number(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  limits.storage_offset_alignment = small_number(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT);
  limits.uniform_blocks_compute = small_number(GL_MAX_COMPUTE_UNIFORM_BLOCKS);
  limits.uniform_block_bytes = number(GL_MAX_UNIFORM_BLOCK_SIZE);
  limits.texture_units_compute = small_number(GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS);
  limits.texture_buffer_texels = number(GL_MAX_TEXTURE_BUFFER_SIZE);
  limits.texture_size = small_number(GL_MAX_TEXTURE_SIZE);
  for (GLuint axis = 0; axis < 3; ++axis) {
    GLint groups = 0;
    glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, axis, &groups);
    limits.groups[axis] = groups;
  }
  limits.group_invocations = small_number(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
  limits.shared_bytes = number(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE);
  return limits;
}

std::uint64_t memory_of(const DeviceInfo& info) {
  constexpr GLenum dedicated_kilobytes = 0x9047;  // GPU_MEMORY_INFO_DEDICATED_VIDMEM_NVX
  if (info.extensions.contains("GL_NVX_gpu_memory_info")) return number(dedicated_kilobytes) * 1024;
  if (!info.software) return 0;
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

DeviceInfo read_info() {
  DeviceInfo info;
  info.name = text(GL_RENDERER);
  info.vendor = text(GL_VENDOR);
  info.version = text(GL_VERSION);
  info.major = small_number(GL_MAJOR_VERSION);
  info.minor = small_number(GL_MINOR_VERSION);
  info.software = is_software(info.name);
  if (info.major < 4 || (info.major == 4 && info.minor < 3)) {
    throw DeviceError(fmt::format("OpenGL 4.3 is needed; {} offers {}.{}", info.name, info.major, info.minor));
  }
  const int extensions = small_number(GL_NUM_EXTENSIONS);
  for (int index = 0; index < extensions; ++index) {
    info.extensions.insert(reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, index)));
  }
  info.program_binary_formats = small_number(GL_NUM_PROGRAM_BINARY_FORMATS);
  info.limits = read_limits();
  info.limits.memory_bytes = memory_of(info);
  return info;
}

// Synchronous, so that a message belongs to the call that was just made. All but errors is switched off in the driver already:
// drivers describe every buffer otherwise.
void listen(Context* context) {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(on_debug_message, context);
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
  glDebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_ERROR, GL_DONT_CARE, 0, nullptr, GL_TRUE);
  glDebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR, GL_DEBUG_SEVERITY_HIGH, 0, nullptr, GL_TRUE);
}

void leave(const EglContext& egl, Context* below) noexcept {
  egl.release();
  current_context = nullptr;
  if (!below) return;
  try {
    below->make_current();
  } catch (const DeviceError&) {
    // A destructor cannot tell; the next call finds no device open, and says so.
  }
}

}  // namespace

Context::Context(const EglPlace& place) : egl(place), below(current_context) {
  try {
    make_current();
    info = read_info();
    info.software = info.software || place.says_software;
    set_up();
  } catch (...) {
    leave(egl, below);
    throw;
  }
}

// The functions of OpenGL are loaded already, into variables that all threads share.
Context::Context(const Context* shared) : egl(&shared->egl), below(current_context), info(shared->info) {
  if (!egl.make_current()) throw DeviceError("eglMakeCurrent failed");
  current_context = this;
  try {
    set_up();
  } catch (...) {
    leave(egl, below);
    throw;
  }
}

void Context::set_up() {
  listen(this);
  glEnable(GL_NONE);  // an error: is it told?
  tells_errors = !errors.empty();
  forget_errors();
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  glEnable(GL_PROGRAM_POINT_SIZE);
  edit_unit = GL_TEXTURE0 + small_number(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS) - 1;
  if (info.extensions.contains("GL_KHR_parallel_shader_compile")) glMaxShaderCompilerThreadsKHR(0xffffffff);  // as many as it likes
  check();
}

Context::~Context() {
  if (current_context == this) {
    leave(egl, below);
    return;
  }
  // Closed out of order: take this one out from under the others.
  for (Context* above = current_context; above; above = above->below) {
    if (above->below == this) above->below = below;
  }
}

void Context::make_current() {
  if (!egl.make_current()) throw DeviceError("eglMakeCurrent failed");
  if (!gladLoadGL(eglGetProcAddress)) throw DeviceError("the OpenGL functions could not be loaded");
  current_context = this;
}

void Context::remember(std::string_view message) {
  if (errors.size() >= errors_kept) return;
  while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) message.remove_suffix(1);
  errors.push_back(*label ? fmt::format("while running '{}': {}", label, message) : std::string(message));
}

void Context::check() {
  bool out_of_memory = false;
  for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError()) {
    if (errors.empty()) remember(error_name(error));  // else the driver has said more already
    out_of_memory = out_of_memory || error == GL_OUT_OF_MEMORY;
    if (error == GL_CONTEXT_LOST) break;  // stays for ever
  }
  if (errors.empty()) return;
  const std::string all = fmt::format("OpenGL error {}", fmt::join(errors, "\nOpenGL error "));
  errors.clear();
  if (out_of_memory) throw DeviceError(all);
  throw DriverError(all);
}

void Context::forget_errors() {
  for (GLenum error = glGetError(); error != GL_NO_ERROR && error != GL_CONTEXT_LOST; error = glGetError()) {
  }
  errors.clear();
}

Context& current() {
  if (!current_context) throw DeviceError("no device is open on this thread");
  return *current_context;
}

Context* current_or_null() noexcept { return current_context; }

void bind_edited(Context& context, GLuint buffer) {
  if (buffer && context.bindings.edited == buffer) return;
  glBindBuffer(edit_point, buffer);
  context.bindings.edited = buffer;
}

void check_allocation(Context& context, std::string_view what, std::string_view label, std::uint64_t bytes) {
  try {
    context.check();
  } catch (const DeviceError&) {
    throw DeviceError(fmt::format("the device is out of memory: {} '{}' needs {} bytes ({:.1f} MiB), which {} cannot give", what,
                                  label, bytes, static_cast<double>(bytes) / (1 << 20), context.info.name));
  }
}

void name_object(GLenum kind, GLuint id, std::string_view label) {
  constexpr std::size_t longest = 255;  // GL_MAX_LABEL_LENGTH is at least 256, the closing zero included
  glObjectLabel(kind, id, static_cast<GLsizei>(std::min(label.size(), longest)), label.data());
}

}  // namespace firn::gpu
