#include "gpu/program.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "gpu/context.h"
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

// Owns a shader object until the program has been linked.
struct Shader {
  explicit Shader(ShaderKind kind) : id(glCreateShader(gl_kind(kind))) {}
  ~Shader() {
    if (current_or_null()) glDeleteShader(id);
  }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  GLuint id;
};

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

// Empty where it compiled.
std::string compile_errors(GLuint id, const ShaderSource& source) {
  const std::string text = with_plain_lines(source.text);
  const char* start = text.data();
  const GLint length = static_cast<GLint>(text.size());
  glShaderSource(id, 1, &start, &length);
  glCompileShader(id);
  GLint compiled = GL_FALSE;
  glGetShaderiv(id, GL_COMPILE_STATUS, &compiled);
  if (compiled) return "";
  const std::string log = mapped_log(shader_log(id), source);
  return log.empty() ? "the driver gives no reason" : log;
}

void delete_program(std::uint32_t id) noexcept {
  Context* context = current_or_null();
  if (!id || !context) return;
  // A program in use would keep its id until another is used.
  if (context->bindings.program == id) glUseProgram(0);
  context->bindings.forget_program(id);
  glDeleteProgram(id);
}

}  // namespace

Program::Program(std::span<const std::pair<ShaderKind, ShaderSource>> shaders, const std::string& label) {
  Context& context = current();
  context.check();
  id_ = glCreateProgram();
  try {
    std::vector<std::unique_ptr<Shader>> compiled;
    std::string errors;
    for (const auto& [kind, source] : shaders) {
      const Shader& shader = *compiled.emplace_back(std::make_unique<Shader>(kind));
      if (!shader.id) context.check();  // a kind that the driver does not know
      const std::string problem = compile_errors(shader.id, source);
      if (!problem.empty()) errors += (errors.empty() ? "" : "\n") + problem;
      glAttachShader(id_, shader.id);
    }
    if (!errors.empty()) {
      context.forget_errors();  // some drivers report the same as errors of the API
      throw ShaderError(fmt::format("'{}' does not compile:\n{}", label, errors));
    }
    glLinkProgram(id_);
    GLint linked = GL_FALSE;
    glGetProgramiv(id_, GL_LINK_STATUS, &linked);
    if (!linked) {
      context.forget_errors();
      // With several shaders nothing tells whose source the ids are of.
      const std::string log = program_log(id_);
      throw ShaderError(
          fmt::format("'{}' does not link:\n{}", label, mapped_log(log, shaders.size() == 1 ? shaders[0].second : ShaderSource{})));
    }
    for (const auto& shader : compiled) glDetachShader(id_, shader->id);
    name_object(GL_PROGRAM, id_, label);
    context.check();
  } catch (...) {
    delete_program(id_);
    throw;
  }
}

Program::~Program() { delete_program(id_); }
Program::Program(Program&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
Program& Program::operator=(Program&& other) noexcept {
  std::swap(id_, other.id_);
  return *this;
}

}  // namespace firn::gpu
