#pragma once

// An OpenGL device reached through EGL without a display. One context per Device, current on the thread that opened it. Of several
// on one thread the last opened is current, and closing it returns to the one before. What is created on a Device (Buffer, Program,
// ...) is used and destroyed while that Device is current, or destroyed when none is open any more. A Device must be closed before
// the program's statics are destroyed, as drivers shut down there too.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace firn::gpu {

// The device cannot do what is asked: no device, OpenGL below 4.3, too small a limit, out of memory. The text says what is missing.
class DeviceError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The driver reported an error while `label` was running (KHR_debug). This is our own mistake or the driver's.
class DriverError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Limits {
  int storage_blocks_compute = 0;  // per compute shader
  int storage_bindings = 0;
  std::uint64_t storage_block_bytes = 0;
  int storage_offset_alignment = 0;
  int uniform_blocks_compute = 0;
  std::uint64_t uniform_block_bytes = 0;
  int texture_units_compute = 0;
  std::uint64_t texture_buffer_texels = 0;
  int texture_size = 0;
  std::uint32_t groups[3] = {0, 0, 0};
  std::uint32_t group_invocations = 0;
  std::uint64_t shared_bytes = 0;
  std::uint64_t memory_bytes = 0;  // of a software renderer: the machine's; 0: the driver does not tell
};

struct DeviceInfo {
  std::string name;  // GL_RENDERER
  std::string vendor;
  std::string version;  // GL_VERSION, names the driver
  int major = 0, minor = 0;
  bool software = false;           // a CPU renderer: llvmpipe, softpipe, swrast
  int program_binary_formats = 0;  // 0: the driver hands out no compiled programs (Mesa without its own shader cache)
  Limits limits;
  std::set<std::string> extensions;
};

class Device {
 public:
  // `choice`: "auto" (hardware first, then software), "software", "hardware", an index as `candidates` lists them, or a part of the
  // device's name. Throws DeviceError, naming what was tried and why each failed.
  static std::unique_ptr<Device> open(const std::string& choice = "auto");

  // Every EGL device and the surfaceless platform, each opened once: what `firn doctor` shows. `problem` is empty where it works.
  struct Candidate {
    std::string where;  // "EGL device 0 (/dev/dri/renderD128)", "surfaceless"
    DeviceInfo info;
    std::string problem;
  };
  static std::vector<Candidate> candidates();

  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  [[nodiscard]] const DeviceInfo& info() const;
  [[nodiscard]] bool has(const std::string& extension) const;
  [[nodiscard]] std::string version_directive() const;  // "#version 450 core", matching the context

  // Names what runs from now on, for driver errors. Cheap: the pointer is kept, so it must outlive the work.
  void label(const char* text);

  // Throws DriverError where the driver reported an error since the last call (DeviceError where it ran out of memory). Every gpu/
  // call that can fail does this itself, save that commands (commands.h) do not ask a driver which tells no errors by itself.
  void check() const;

  void finish();

  // Calls `job` for each of 0 .. count - 1, on this thread and as many more as `threads` allows. Each further thread has a context
  // of its own, which shares buffers, textures and programs with this device's but not what is bound; all that job() created is
  // there for all when this returns. Throws the exception of the lowest number, once all have ended.
  void share_out(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& job);

 private:
  struct State;
  explicit Device(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace firn::gpu
