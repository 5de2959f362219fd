#pragma once

// GLSL programs from source, with compile errors told in the user's own file and line.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace firn::gpu {

// A shader did not compile or link. what() has one "file:line: error: ..." per message of the driver.
class ShaderError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Source text assembled from several files. Lines `#line N ID` in it tell that the next line is line N of files[ID].
struct ShaderSource {
  std::string text;
  std::vector<std::string> files;  // 0 is "generated"
};

// Appends `file` to `source`, expanding `#include "path"` (looked up in `include_dirs`, each file at most once, cycles harmless)
// and writing #line directives. Throws ShaderError with file:line where an include is missing, naming the folders searched.
void append_file(ShaderSource& source, const std::filesystem::path& file, std::span<const std::filesystem::path> include_dirs);

// The driver's log in terms of the user's files, one "file:line: error: message" per line. Knows how Mesa ("0:12(3): error: ..."),
// NVIDIA
// ("0(12) : error ...") and Intel and AMD ("ERROR: 0:12: ...") begin a message; other lines stay as they are. A position in source
// 0 is a line of the whole text: Program hides the #line directives from the driver, because Mesa forgets their ids in most
// messages.
std::string mapped_log(std::string_view log, const ShaderSource& source);

enum class ShaderKind { compute, vertex, fragment, tessellation_control, tessellation_evaluation, geometry };

// All that a program is made of. `label` names it in errors, of the driver too, and in debuggers.
struct ProgramSource {
  std::vector<std::pair<ShaderKind, ShaderSource>> shaders;
  std::string label;
};

// A linked program. Throws ShaderError.
class Program {
 public:
  Program() = default;
  Program(std::span<const std::pair<ShaderKind, ShaderSource>> shaders, const std::string& label);
  ~Program();
  Program(Program&& other) noexcept;
  Program& operator=(Program&& other) noexcept;
  [[nodiscard]] std::uint32_t id() const { return id_; }

 private:
  friend struct ProgramMaking;
  explicit Program(std::uint32_t id) : id_(id) {}
  std::uint32_t id_ = 0;
};

class ProgramCache;

// The program as an earlier start left it, if the device still takes that. Always nothing where the driver hands out no programs
// (DeviceInfo::program_binary_formats).
std::optional<Program> cached_program(const ProgramSource& source, const ProgramCache& cache);

// Compiles, and leaves the programs in `cache` unless it is null. All sources are handed to the driver before the first result is
// asked for, as those with GL_KHR_parallel_shader_compile then work on several at once. Throws ShaderError with what is wrong with
// any of them.
std::vector<Program> compile_programs(std::span<const ProgramSource> sources, const ProgramCache* cache);

}  // namespace firn::gpu
