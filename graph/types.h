#pragma once

// The vocabulary of ports: what an element is, who touches it and how.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace firn::graph {

// Names in files are GLSL's: float, vec3, mat3, ... In memory (std430): vec3 and ivec3 fill 16 bytes, mat3 is three padded columns.
enum class ElementType { float1, vec2, vec3, vec4, int1, ivec2, ivec3, ivec4, uint1, uvec2, uvec3, uvec4, mat3, rgba8, depth };

std::string_view name(ElementType type);
std::optional<ElementType> element_type(std::string_view name);
std::vector<std::string> element_type_names();

enum class Scalar { real, integer, natural, byte };
Scalar scalar(ElementType type);
int components(ElementType type);        // without padding: vec3 3, mat3 9
std::uint64_t stride(ElementType type);  // bytes from one element to the next
bool is_texel(ElementType type);         // rgba8, depth: only in textures

// accumulate: atomic adds, in any order; the buffer's former content counts.
enum class Access { read, write, read_write, accumulate };
std::string_view name(Access access);
std::optional<Access> access(std::string_view name);
bool reads(Access access);  // the content before the access matters
bool writes(Access access);

enum class Usage { storage, uniform, sampled, image, vertex, indirect, transfer, host, framebuffer };
std::string_view name(Usage usage);
std::optional<Usage> usage(std::string_view name);

// A parameter's or constant's value.
using Vector3 = std::array<double, 3>;
using Value = std::variant<double, std::int64_t, bool, std::string, Vector3>;
std::string to_string(const Value& value);

}  // namespace firn::graph
