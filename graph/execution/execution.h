#pragma once

// A plan on a device.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "graph/plan.h"
#include "graph/registry.h"

namespace firn::execution {

// The numbers broke: NaN, overflow, a particle outside the domain. The text names stage, step and count.
class NumbersError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Options {
  std::vector<std::filesystem::path> shader_folders;  // searched in this order, for kernels and their includes
  bool barriers_all = false;                          // a full barrier after every piece of work instead of the plan's own
  bool profile = false;                               // time every piece of work
  std::filesystem::path program_cache = {};           // folder for compiled programs (gpu/program_cache.h); empty: none
};

// One piece of work, timed since the last call of take_times().
struct PassTime {
  int stage = 0;
  int work = 0;
  std::uint64_t step = 0;  // of the clock
  double start = 0;        // s since the execution was made
  double seconds = 0;
};

// The groups of one indirect dispatch, as the device found them.
struct PassGroups {
  int stage = 0;
  int work = 0;
  std::uint64_t groups = 0;
};

// How often a repeat has run, and how many turns that took in all; in the order of the plan.
struct RepeatTurns {
  config::Place place;
  std::int64_t max = 1;
  std::uint64_t rounds = 0, turns = 0;
};

// What the device lacks for a plan, one sentence each; empty: nothing.
std::vector<std::string> shortcomings(const graph::Plan& plan, const gpu::Limits& limits);

class Execution {
 public:
  // Allocates buffers, compiles kernels, makes host stages. Throws gpu::DeviceError where the device cannot do it (before anything
  // is allocated), gpu::ShaderError where a kernel does not compile, config::InputError where that of a stage's file does not.
  Execution(gpu::Device& device, graph::Plan plan, const graph::Registry& registry, Options options);
  ~Execution();
  Execution(const Execution&) = delete;
  Execution& operator=(const Execution&) = delete;

  void setup();
  // One step of the clock's dt, or of what a stage with sets_time_step makes of it; then the clock goes on.
  void step();
  // Draws and writes the current state; then the frame number goes on.
  void frame();
  void finish();

  // Before a checkpoint: everything that stages write is in files. Faults are told before.
  void flush();
  // Instead of setup(), once the buffers that graph/carried.h names have their contents by write(): the clock goes on from there.
  void resume(const graph::Clock& clock);

  // How many elements of a domain there are, as a checkpoint says; at most as many as were planned. Contents stay as they are.
  void resize(const std::string& domain, std::uint64_t count);

  // Waits for the device.
  [[nodiscard]] std::vector<RepeatTurns> turns() const;

  // Throws NumbersError where kernels have reported a fault. Waits for the device.
  void check_faults();

  [[nodiscard]] graph::Clock& clock();
  // As it stands: where elements come and go, domains and buffers have the numbers of now, not those there is room for.
  [[nodiscard]] const graph::Plan& plan() const;

  // The contents of a buffer in device layout, and the reverse. Throws std::out_of_range for an unknown name.
  [[nodiscard]] std::vector<std::byte> read(const std::string& buffer) const;
  void write(const std::string& buffer, std::span<const std::byte> data);

  // One step in which the device is waited for before every indirect dispatch, and asked how many groups it will have; in order.
  std::vector<PassGroups> step_counting_groups();

  // Pieces of work from now on; dispatches that are left out are none. At first as Options::profile says. Times are the device's
  // timestamps, taken in a ring and read when they are there; on software renderers, and for host work everywhere, the processor's
  // clock.
  void time_passes(bool on);
  // Those not taken yet. Without `wait` only those that can be had at once.
  std::vector<PassTime> take_times(bool wait = true);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace firn::execution
