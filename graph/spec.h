#pragma once

// What a stage is, as plain data: ports, parameters and work. Everything else - binding, barriers, timing, the declarations in its
// GLSL, its help text - is derived from this.

#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "graph/types.h"

namespace firn::graph {

// Holds where the choice parameter (or the choice of the environment, see environment.h) `name` has the value `value`.
// An empty name always holds.
struct Condition {
  std::string name;
  std::string value;
};

// A number of elements: a count ("4"), a domain of the environment ("particles"), or one scaled, rounded up ("nodes/256",
// "particles*64").
using DomainText = std::string;

struct Port {
  std::string name;  // also the buffer it binds to, unless the pipeline says otherwise
  ElementType type = ElementType::float1;
  DomainText domain;
  Access access = Access::read;
  Usage usage = Usage::storage;
  std::string unit;  // SI; "1" for pure numbers
  std::string doc;
  bool optional = false;   // may stay unbound; then HAS_<NAME> is 0 in its kernels
  Condition when = {};     // the port exists only where this holds
  bool repeatable = true;  // false: what it holds depends on the order in which invocations run, though results do not
};

enum class ParameterKind { number, integer, boolean, choice, vector3, path };

struct ParameterSpec {
  std::string name;
  ParameterKind kind = ParameterKind::number;
  Value initial = 0.0;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices = {};
  std::string unit = "1";
  std::string doc;
};

// What can go wrong with the numbers while a kernel runs; it says so by fault(FAULT_...) and the run ends.
enum class Fault { not_a_number, overflow, left_domain };
std::string_view describe(Fault fault);  // "a value that is not a number"
inline constexpr int fault_kinds = 3;

// A port as one piece of work touches it, where that differs from what the port says of the stage as a whole.
struct PortUse {
  std::string port;
  Access access = Access::read;
  std::optional<Usage> usage = {};  // none: the port's
};

// Additions and multiplications for each element of a domain, as the formulas ask for them: what a kernel works out twice counts
// once.
struct Arithmetic {
  DomainText per;
  double operations = 0;
  Condition when = {};
};

// One compute dispatch. Kernels are files below shaders/.
struct Dispatch {
  std::string kernel;              // "mpm/particles_to_grid.comp"
  DomainText over;                 // invocations, one per element; empty where `indirect` is given
  std::string indirect = {};       // port with three uint: groups
  int group = 64;                  // invocations per work group
  DomainText needs = {};           // nothing is done where this domain has no elements
  std::vector<PortUse> uses = {};  // empty: every port of the stage
  Condition when = {};
  std::vector<Arithmetic> arithmetic = {};  // empty: not known
};

enum class Topology { points, lines, triangles, triangle_strip, patches };

// One draw without vertex attributes: vertex shaders fetch by gl_VertexID and gl_InstanceID.
struct Draw {
  std::string name;
  std::string vertex, fragment;
  std::string tessellation_control = {}, tessellation_evaluation = {};
  std::vector<std::string> colors = {};  // ports with usage framebuffer
  std::string depth = {};                // port of type depth; empty: no depth test
  DomainText instances = "1";
  DomainText vertices = "3";
  Topology topology = Topology::triangles;
  int patch_vertices = 4;
  // Beforehand the depth to 1, or where there is none the colors to 0. Beside a depth, colors are void where it is still 1.
  bool clear = false;
  bool depth_write = true;
  bool wireframe = false;
  std::vector<PortUse> uses = {};
  Condition when = {};
};

// The stage's C++ runs (see host.h). Its ports have usage host.
struct HostWork {
  std::vector<PortUse> uses = {};
  Condition when = {};
};

using Work = std::variant<Dispatch, Draw, HostWork>;

struct StageSpec {
  std::string name;      // "mpm.particles_to_grid"
  std::string doc;       // one line
  std::string equation;  // "[M 17-20]"
  std::vector<Port> ports;
  std::vector<ParameterSpec> parameters = {};
  std::vector<std::string> constants = {};  // names of environment constants that its kernels use
  std::vector<Fault> faults = {};
  bool sets_time_step = false;
  std::string resizes = {};  // domain whose elements its host work makes come and go (host.h); empty: none
  std::vector<Work> work;
};

// Mistakes in a spec itself: duplicate names, uses of ports that are not there, defaults outside their range, ... Empty: none.
std::vector<std::string> problems(const StageSpec& spec);

}  // namespace firn::graph
