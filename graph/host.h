#pragma once

// The face that the graph shows to stages which run C++ on the host: reading scene data in, writing files out, rigid bodies.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph/types.h"

namespace firn::graph {

// Simulated time. The same four values are visible in every kernel as `dt`, `time`, `step` and `frame`.
struct Clock {
  double dt = 0;    // s, of the step now running
  double time = 0;  // s, at the start of the step
  std::uint64_t step = 0;
  std::uint64_t frame = 0;
};

struct PortView {
  ElementType type = ElementType::float1;
  std::uint64_t count = 0;
  int width = 0, height = 0;  // textures
};

// Valid only during the call of HostStage::run. Ports by name; a port that the spec does not declare is std::logic_error.
class HostContext {
 public:
  virtual ~HostContext() = default;
  [[nodiscard]] virtual PortView view(std::string_view port) const = 0;
  [[nodiscard]] virtual bool bound(std::string_view port) const = 0;
  virtual std::vector<std::byte> read(std::string_view port) = 0;                  // stride(type) bytes per element
  virtual void read_into(std::string_view port, std::span<std::byte> data) = 0;    // the same, into memory that is there
  virtual void write(std::string_view port, std::span<const std::byte> data) = 0;  // the whole buffer
  [[nodiscard]] virtual const Clock& clock() const = 0;
  virtual void set_time_step(double dt) = 0;  // only for specs with sets_time_step

  // Elements come and go, of the domain that the spec `resizes`; the plan has room for as many as there were at first. Every buffer
  // over the domain that is kept between steps goes along, whether it is a port of this stage or not.
  virtual void keep(std::span<const std::uint32_t> elements) = 0;  // ascending; the others go, the order stays
  virtual void append(std::uint64_t count) = 0;                    // behind those that are there; zeros
  // Elements from `first` on.
  virtual void write_from(std::string_view port, std::uint64_t first, std::span<const std::byte> data) = 0;

  // Unpadded values: `components(type)` scalars per element.
  std::vector<float> read_floats(std::string_view port);
  std::vector<std::int32_t> read_integers(std::string_view port);
  void write_floats(std::string_view port, std::span<const float> values);
  void write_integers(std::string_view port, std::span<const std::int32_t> values);
};

using ParameterValues = std::map<std::string, Value>;

class HostStage {
 public:
  virtual ~HostStage() = default;
  virtual void run(HostContext& context) = 0;
  virtual void finish() {}  // once, after the last frame of a run that ended well
  // A checkpoint follows: everything that run() was given until now is in files when this returns, so that a run which dies later
  // and goes on from there misses nothing.
  virtual void flush() {}
  // The run goes on from a checkpoint instead of from the start: `clock` has the next frame. Called before any run(); what an
  // earlier process wrote of this and later frames is void.
  virtual void resume(const Clock& clock) { static_cast<void>(clock); }
};

using HostFactory = std::function<std::unique_ptr<HostStage>(const ParameterValues& parameters)>;

// Padded device layout <-> packed scalars of 4 bytes.
std::vector<std::byte> unpadded(ElementType type, std::span<const std::byte> padded);
std::vector<std::byte> padded(ElementType type, std::span<const std::byte> unpadded);

}  // namespace firn::graph
