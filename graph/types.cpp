#include "graph/types.h"

#include <fmt/format.h>

#include <algorithm>

namespace firn::graph {
namespace {

struct TypeFacts {
  ElementType type;
  std::string_view name;
  Scalar scalar;
  int components;
  std::uint64_t stride;
};

constexpr std::array<TypeFacts, 15> type_table{{
    {ElementType::float1, "float", Scalar::real, 1, 4},
    {ElementType::vec2, "vec2", Scalar::real, 2, 8},
    {ElementType::vec3, "vec3", Scalar::real, 3, 16},
    {ElementType::vec4, "vec4", Scalar::real, 4, 16},
    {ElementType::int1, "int", Scalar::integer, 1, 4},
    {ElementType::ivec2, "ivec2", Scalar::integer, 2, 8},
    {ElementType::ivec3, "ivec3", Scalar::integer, 3, 16},
    {ElementType::ivec4, "ivec4", Scalar::integer, 4, 16},
    {ElementType::uint1, "uint", Scalar::natural, 1, 4},
    {ElementType::uvec2, "uvec2", Scalar::natural, 2, 8},
    {ElementType::uvec3, "uvec3", Scalar::natural, 3, 16},
    {ElementType::uvec4, "uvec4", Scalar::natural, 4, 16},
    {ElementType::mat3, "mat3", Scalar::real, 9, 48},
    {ElementType::rgba8, "rgba8", Scalar::byte, 4, 4},
    {ElementType::depth, "depth", Scalar::real, 1, 4},
}};

const TypeFacts& facts(ElementType type) { return type_table.at(static_cast<std::size_t>(type)); }

constexpr std::array<std::string_view, 4> access_names{"read", "write", "read_write", "accumulate"};
constexpr std::array<std::string_view, 9> usage_names{"storage",  "uniform",  "sampled", "image",      "vertex",
                                                      "indirect", "transfer", "host",    "framebuffer"};

template <typename Enum, std::size_t N>
std::optional<Enum> by_name(const std::array<std::string_view, N>& names, std::string_view text) {
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) return std::nullopt;
  return static_cast<Enum>(found - names.begin());
}

}  // namespace

std::string_view name(ElementType type) { return facts(type).name; }

std::optional<ElementType> element_type(std::string_view text) {
  for (const TypeFacts& type : type_table)
    if (type.name == text) return type.type;
  return std::nullopt;
}

std::vector<std::string> element_type_names() {
  std::vector<std::string> names;
  for (const TypeFacts& type : type_table) names.emplace_back(type.name);
  return names;
}

Scalar scalar(ElementType type) { return facts(type).scalar; }
int components(ElementType type) { return facts(type).components; }
std::uint64_t stride(ElementType type) { return facts(type).stride; }
bool is_texel(ElementType type) { return type == ElementType::rgba8 || type == ElementType::depth; }

std::string_view name(Access access) { return access_names.at(static_cast<std::size_t>(access)); }
std::optional<Access> access(std::string_view text) { return by_name<Access>(access_names, text); }
bool reads(Access access) { return access != Access::write; }
bool writes(Access access) { return access != Access::read; }

std::string_view name(Usage usage) { return usage_names.at(static_cast<std::size_t>(usage)); }
std::optional<Usage> usage(std::string_view text) { return by_name<Usage>(usage_names, text); }

std::string to_string(const Value& value) {
  struct Visitor {
    std::string operator()(double number) const { return fmt::format("{:g}", number); }
    std::string operator()(std::int64_t number) const { return std::to_string(number); }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(const std::string& text) const { return text; }
    std::string operator()(const Vector3& v) const { return fmt::format("[{:g}, {:g}, {:g}]", v[0], v[1], v[2]); }
  };
  return std::visit(Visitor{}, value);
}

}  // namespace firn::graph
