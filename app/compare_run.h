#pragma once

// One of the two sides of a comparison: a pipeline run on a scene, with what is to be compared.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/load.h"
#include "app/simulation.h"
#include "gpu/device.h"
#include "stages/png.h"

namespace firn::app {

struct PassTimes {
  std::string phase, stage, work;
  std::vector<double> seconds;  // one per launch
  [[nodiscard]] double total() const;
};

struct Contents {
  graph::ElementType type = graph::ElementType::float1;
  std::string domain, unit;
  std::vector<std::byte> packed;  // scalars of 4 bytes, without padding
  [[nodiscard]] double value(std::size_t scalar) const;
  [[nodiscard]] std::size_t scalars() const { return packed.size() / 4; }
};

struct Mass {
  std::string of;  // "particles", "the field"
  double kilograms = 0;
};

struct Side {
  std::string letter, pipeline, changes;  // "A", its name, its own --set in words
  std::uint64_t steps = 0, frames = 0, device_bytes = 0;
  double simulated = 0, seconds = 0;        // s: of the scene, by the clock on the wall
  std::vector<PassTimes> passes;            // in the order of the plan
  std::map<std::string, Contents> buffers;  // state at the end that several stages work with
  std::vector<Mass> masses;
  std::optional<stages::Picture> picture;  // of that state
  bool interrupted = false;

  [[nodiscard]] std::string title() const;             // "A: mpm_snow, kernel=quadratic"
  [[nodiscard]] double milliseconds_per_step() const;  // in the passes of the step
};

// Throws as a run does; what broke the numbers tells the side.
Side run_side(const std::string& letter, const Inputs& inputs, const std::string& changes, Loaded loaded, gpu::Device& device,
              const Until& until, bool quiet);

}  // namespace firn::app
