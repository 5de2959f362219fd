#include "gpu/program.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "gpu/context.h"
#include "gpu/program_cache.h"
#include "gpu/shader_source.h"

namespace firn::gpu {

namespace {

GLenum gl_kind(ShaderKind kind) {
  switch (kind) {
    case ShaderKind::compute:
      return GL_COMPUTE_SHADER;
    case ShaderKind::vertex:
      return GL_VERTEX_SHADER;
    case ShaderKind::fragment:
      return GL_FRAGMENT_SHADER;
    case ShaderKind::tessellation_control:
      return GL_TESS_CONTROL_SHADER;
    case ShaderKind::tessellation_evaluation:
      return GL_TESS_EVALUATION_SHADER;
    case ShaderKind::geometry:
      return GL_GEOMETRY_SHADER;
  }
  throw std::logic_error("unknown kind of shader");
}

void delete_program(std::uint32_t id) noexcept {
  Context* context = current_or_null();
  if (!id || !context) return;
  // A program in use would keep its id until another is used.
  if (context->bindings.program == id) glUseProgram(0);
  context->bindings.forget_program(id);
  glDeleteProgram(id);
}

std::string shader_log(GLuint id) {
  GLint length = 0;
  glGetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(length, '\0');
  glGetShaderInfoLog(id, length, &length, log.data());
  log.resize(length);
  return log;
}

std::string program_log(GLuint id) {
  GLint length = 0;
  glGetProgramiv(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(length, '\0');
  glGetProgramInfoLog(id, length, &length, log.data());
  log.resize(length);
  return log;
}

bool is_linked(GLuint id) {
  GLint linked = GL_FALSE;
  glGetProgramiv(id, GL_LINK_STATUS, &linked);
  return linked == GL_TRUE;
}

// A program that the driver has been told to compile and link, and has not been asked about.
class Compilation {
 public:
  Compilation(const ProgramSource& source, bool to_be_stored) : source_(&source), program_(glCreateProgram()) {
    if (to_be_stored) glProgramParameteri(program_, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
    for (const auto& [kind, text] : source.shaders) {
      const GLuint shader = shaders_.emplace_back(glCreateShader(gl_kind(kind)));
      if (!shader) continue;  // a kind that the driver does not know, which errors() tells
      const std::string plain = with_plain_lines(text.text);
      const char* start = plain.data();
      const GLint length = static_cast<GLint>(plain.size());
      glShaderSource(shader, 1, &start, &length);
      glCompileShader(shader);
      glAttachShader(program_, shader);
    }
    glLinkProgram(program_);
  }
  ~Compilation() {
    if (!current_or_null()) return;
    for (const GLuint shader : shaders_) glDeleteShader(shader);
    delete_program(program_);
  }
  Compilation(Compilation&& other) noexcept
      : source_(other.source_), shaders_(std::move(other.shaders_)), program_(std::exchange(other.program_, 0)) {}
  Compilation& operator=(Compilation&&) = delete;

  // Waits. Empty where all went well.
  [[nodiscard]] std::string errors() const {
    if (is_linked(program_)) return "";
    std::string errors;
    for (std::size_t i = 0; i < shaders_.size(); ++i) {
      GLint compiled = GL_FALSE;
      if (shaders_[i]) glGetShaderiv(shaders_[i], GL_COMPILE_STATUS, &compiled);
      if (compiled) continue;
      const std::string log = shaders_[i] ? mapped_log(shader_log(shaders_[i]), source_->shaders[i].second) : "";
      errors += (errors.empty() ? "" : "\n") + (log.empty() ? "the driver gives no reason" : log);
    }
    if (!errors.empty()) return fmt::format("'{}' does not compile:\n{}", source_->label, errors);
    // With several shaders nothing tells whose source the ids are of.
    const ShaderSource& source = source_->shaders.size() == 1 ? source_->shaders[0].second : ShaderSource{};
    return fmt::format("'{}' does not link:\n{}", source_->label, mapped_log(program_log(program_), source));
  }

  // Once there are no errors.
  GLuint take() {
    for (const GLuint shader : shaders_) glDetachShader(program_, shader);
    name_object(GL_PROGRAM, program_, source_->label);
    return std::exchange(program_, 0);
  }

 private:
  const ProgramSource* source_;
  std::vector<GLuint> shaders_;
  GLuint program_ = 0;
};

// Another driver, another version of it, or another source: another key.
std::string key_of(const ProgramSource& source, const DeviceInfo& device) {
  std::string all = fmt::format("{}\n{}\n{}\n", device.vendor, device.name, device.version);
  for (const auto& [kind, text] : source.shaders) {
    const std::string plain = with_plain_lines(text.text);
    all += fmt::format("{} {}\n{}", static_cast<int>(kind), plain.size(), plain);
  }
  return digest(all);
}

void store(const ProgramSource& source, GLuint program, const ProgramCache& cache, Context& context) {
  GLint length = 0;
  glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &length);
  if (length <= 0) return;
  ProgramCache::Entry entry;
  entry.binary.resize(length);
  GLenum format = 0;
  glGetProgramBinary(program, length, &length, &format, entry.binary.data());
  entry.binary.resize(length);
  entry.format = format;
  context.check();
  cache.store(key_of(source, context.info), entry);
}

}  // namespace

struct ProgramMaking {
  static Program own(GLuint id) { return Program(id); }
};

std::optional<Program> cached_program(const ProgramSource& source, const ProgramCache& cache) {
  Context& context = current();
  if (context.info.program_binary_formats == 0) return std::nullopt;
  const std::string key = key_of(source, context.info);
  const std::optional<ProgramCache::Entry> entry = cache.find(key);
  if (!entry) return std::nullopt;
  context.check();
  Program program = ProgramMaking::own(glCreateProgram());
  glProgramBinary(program.id(), entry->format, entry->binary.data(), static_cast<GLsizei>(entry->binary.size()));
  const bool taken = is_linked(program.id());
  context.forget_errors();  // of a format that the driver does not know any more
  if (!taken) {
    cache.remove(key, fmt::format("{} does not take it any more", context.info.name));
    return std::nullopt;
  }
  name_object(GL_PROGRAM, program.id(), source.label);
  context.check();
  return program;
}

std::vector<Program> compile_programs(std::span<const ProgramSource> sources, const ProgramCache* cache) {
  Context& context = current();
  context.check();
  if (context.info.program_binary_formats == 0) cache = nullptr;
  std::vector<Compilation> compilations;
  compilations.reserve(sources.size());
  for (const ProgramSource& source : sources) compilations.emplace_back(source, cache != nullptr);
  std::vector<std::string> errors;
  for (const Compilation& compilation : compilations) {
    const std::string error = compilation.errors();
    if (!error.empty() && std::find(errors.begin(), errors.end(), error) == errors.end()) errors.push_back(error);
  }
  if (!errors.empty()) {
    context.forget_errors();  // some drivers report the same as errors of the API
    throw ShaderError(fmt::format("{}", fmt::join(errors, "\n")));
  }
  std::vector<Program> programs;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    programs.push_back(ProgramMaking::own(compilations[i].take()));
    if (cache) store(sources[i], programs.back().id(), *cache, context);
  }
  context.check();
  return programs;
}

Program::Program(std::span<const std::pair<ShaderKind, ShaderSource>> shaders, const std::string& label) {
  const ProgramSource source{{shaders.begin(), shaders.end()}, label};
  *this = std::move(compile_programs(std::span(&source, 1), nullptr).front());
}

Program::~Program() { delete_program(id_); }
Program::Program(Program&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
Program& Program::operator=(Program&& other) noexcept {
  std::swap(id_, other.id_);
  return *this;
}

}  // namespace firn::gpu
