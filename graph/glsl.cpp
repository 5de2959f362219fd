#include "graph/glsl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <set>

namespace firn::graph {
namespace {

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  return text;
}

// One member of the parameter block: everything a stage's kernels get as uniforms.
struct Member {
  ElementType type = ElementType::float1;  // float1, int1, uint1, vec3, ivec3
  std::string name;
  Value value;
};

std::vector<Member> block_members(const Plan& plan, const PlannedStage& stage) {
  std::vector<Member> members;
  for (const ParameterSpec& parameter : stage.spec.parameters) {
    const Value& value = stage.parameters.at(parameter.name);
    if (parameter.kind == ParameterKind::number) members.push_back({ElementType::float1, parameter.name, value});
    if (parameter.kind == ParameterKind::integer) members.push_back({ElementType::int1, parameter.name, value});
    if (parameter.kind == ParameterKind::vector3) members.push_back({ElementType::vec3, parameter.name, value});
  }
  for (const std::string& name : stage.spec.constants)
    if (const Constant* constant = plan.environment.constant(name)) members.push_back({constant->type, name, constant->value});
  std::set<std::string> domains;
  for (const Port& port : stage.spec.ports)
    if (const std::string base = base_domain(port.domain); !base.empty()) domains.insert(base);
  for (const std::string& domain : domains) {
    const auto known = plan.environment.domains.find(domain);
    if (known == plan.environment.domains.end()) continue;  // of optional ports that are not bound
    const DomainSize& size = known->second;
    members.push_back({ElementType::uint1, domain + "_count", static_cast<std::int64_t>(size.count)});
    if (size.width > 0) {
      members.push_back({ElementType::int1, domain + "_width", static_cast<std::int64_t>(size.width)});
      members.push_back({ElementType::int1, domain + "_height", static_cast<std::int64_t>(size.height)});
    }
  }
  return members;
}

double real(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
  return 0;
}

void append_scalar(std::vector<std::byte>& bytes, ElementType type, double value) {
  const auto put = [&](auto v) {
    const auto at = bytes.size();
    bytes.resize(at + 4);
    std::memcpy(&bytes[at], &v, 4);
  };
  switch (scalar(type)) {
    case Scalar::real:
      put(static_cast<float>(value));
      break;
    case Scalar::integer:
      put(static_cast<std::int32_t>(value));
      break;
    case Scalar::natural:
    case Scalar::byte:
      put(static_cast<std::uint32_t>(value));
      break;
  }
}

std::string texel_prefix(ElementType type) {
  switch (scalar(type)) {
    case Scalar::integer:
      return "i";
    case Scalar::natural:
      return "u";
    default:
      return "";
  }
}

std::string_view swizzle(ElementType type) {
  constexpr std::string_view letters = ".xyzw";
  return letters.substr(0, static_cast<std::size_t>(components(type)) + 1);
}

std::string sampled_declaration(const Port& port, const PlannedBuffer& buffer, int unit) {
  const std::string prefix = texel_prefix(port.type);
  if (buffer.texture) return fmt::format("layout(binding = {}) uniform {}sampler2D {};\n", unit, prefix, port.name);
  std::string text = fmt::format("layout(binding = {}) uniform {}samplerBuffer {}_texels;\n", unit, prefix, port.name);
  if (port.type == ElementType::mat3)
    return text + fmt::format(
                      "mat3 {0}_at(int index) {{\n  return mat3(texelFetch({0}_texels, 3 * index).xyz, texelFetch({0}_texels, 3 * "
                      "index + 1).xyz,\n              texelFetch({0}_texels, 3 * index + 2).xyz);\n}}\n",
                      port.name);
  return text + fmt::format("{0} {1}_at(int index) {{ return texelFetch({1}_texels, index){2}; }}\n", name(port.type), port.name,
                            swizzle(port.type));
}

std::string storage_declaration(const Port& port, Access access, int binding, const DeviceTraits& traits) {
  if (access == Access::accumulate) {
    const bool real_sum = scalar(port.type) == Scalar::real;
    const std::string_view type =
        !real_sum ? (scalar(port.type) == Scalar::integer ? "int" : "uint") : (traits.float_atomics ? "float" : "uint");
    return fmt::format("layout(std430, binding = {}) coherent buffer {}_block {{ {} {}[]; }};\n", binding, port.name, type,
                       port.name);
  }
  const std::string_view qualifier = access == Access::read ? "readonly " : access == Access::write ? "writeonly " : "";
  return fmt::format("layout(std430, binding = {}) {}buffer {}_block {{ {} {}[]; }};\n", binding, qualifier, port.name,
                     name(port.type), port.name);
}

std::string uniform_declaration(const Port& port, const PlannedBuffer& buffer, int binding) {
  const std::string extent = buffer.count == 1 ? "" : fmt::format("[{}]", buffer.count);
  return fmt::format("layout(std140, binding = {}) uniform {}_block {{ {} {}{}; }};\n", binding, port.name, name(port.type),
                     port.name, extent);
}

// The formats that textures of these types have on the device; vec3 is padded to four floats there too.
std::string image_format(ElementType type) {
  if (type == ElementType::rgba8) return "rgba8";
  const int channels = components(type) == 3 ? 4 : components(type);
  constexpr std::array<std::string_view, 5> letters{"", "r", "rg", "rgb", "rgba"};
  const std::string kind = scalar(type) == Scalar::real ? "f" : texel_prefix(type) == "u" ? "ui" : "i";
  return fmt::format("{}32{}", letters.at(static_cast<std::size_t>(channels)), kind);
}

std::string image_declaration(const Port& port, Access access, int unit) {
  const std::string_view qualifier = access == Access::read ? "readonly " : access == Access::write ? "writeonly " : "";
  return fmt::format("layout({}, binding = {}) {}uniform {}image2D {};\n", image_format(port.type), unit, qualifier,
                     texel_prefix(port.type), port.name);
}

std::string fault_declarations(int binding, int stage) {
  return fmt::format(
      "const uint FAULT_NOT_A_NUMBER = 0u;\nconst uint FAULT_OVERFLOW = 1u;\nconst uint FAULT_LEFT_DOMAIN = 2u;\n"
      "layout(std430, binding = {}) coherent buffer fault_block {{ uint fault_counts[]; }};\n"
      "void fault(uint kind) {{\n  uint slot = 2u * ({}u + kind);\n  atomicAdd(fault_counts[slot], 1u);\n"
      "  atomicMax(fault_counts[slot + 1u], 0xffffffffu - step);\n}}\n",
      binding, stage * fault_kinds);
}

std::string parameter_declarations(const Plan& plan, const PlannedStage& stage) {
  std::string text;
  for (const ParameterSpec& parameter : stage.spec.parameters) {
    const Value& value = stage.parameters.at(parameter.name);
    if (parameter.kind == ParameterKind::boolean) text += fmt::format("const bool {} = {};\n", parameter.name, to_string(value));
    if (parameter.kind == ParameterKind::choice)
      for (const std::string& choice : parameter.choices)
        text +=
            fmt::format("#define {}_{} {}\n", upper(parameter.name), upper(choice), std::get<std::string>(value) == choice ? 1 : 0);
  }
  const std::vector<Member> members = block_members(plan, stage);
  if (!members.empty()) {
    text += fmt::format("layout(std140, binding = {}) uniform stage_parameters_block {{\n", parameter_block_binding);
    for (const Member& member : members) text += fmt::format("  {} {};\n", name(member.type), member.name);
    text += "};\n";
  }
  return text +
         fmt::format("layout(std140, binding = {}) uniform clock_block {{ float dt; float time; uint step; uint frame; }};\n",
                     clock_block_binding);
}

std::string extension_lines(const DeviceTraits& traits, const PlannedStage& stage) {
  std::string text =
      fmt::format("{}#define FIRN_FLOAT_ATOMICS {}\n",
                  traits.float_atomics ? "#extension GL_NV_shader_atomic_float : require\n" : "", traits.float_atomics ? 1 : 0);
  if (needs_subgroups(stage) && traits.subgroup_size >= least_subgroup)
    text += fmt::format("#extension {} : require\n#define FIRN_SUBGROUPS 1\n", subgroup_extension);
  return text;
}

}  // namespace

bool needs_subgroups(const PlannedStage& stage) {
  const auto form = stage.parameters.find("form");
  return form != stage.parameters.end() && form->second == Value(std::string("subgroup"));
}

std::vector<UsedPort> used_ports(const PlannedStage& stage, const Work& work) {
  std::vector<UsedPort> used;
  const auto add = [&](const std::string& name, std::optional<Access> access, std::optional<Usage> usage) {
    for (int p = 0; p < static_cast<int>(stage.spec.ports.size()); ++p) {
      const Port& port = stage.spec.ports[static_cast<std::size_t>(p)];
      if (port.name != name || stage.buffers[static_cast<std::size_t>(p)] < 0) continue;
      const UsedPort use{p, access.value_or(port.access), usage.value_or(port.usage)};
      // A kernel may read the buffer of its own group counts in other ways as well.
      const bool again = usage == Usage::indirect;
      if (std::ranges::none_of(used, [&](const UsedPort& u) { return u.port == p && (!again || u.usage == use.usage); }))
        used.push_back(use);
    }
  };
  const std::vector<PortUse>& uses = std::visit([](const auto& w) -> const std::vector<PortUse>& { return w.uses; }, work);
  for (const PortUse& use : uses) add(use.port, use.access, use.usage);
  if (uses.empty())
    for (const Port& port : stage.spec.ports) add(port.name, {}, {});
  if (const auto* dispatch = std::get_if<Dispatch>(&work); dispatch && !dispatch->indirect.empty())
    add(dispatch->indirect, Access::read, Usage::indirect);
  if (const auto* draw = std::get_if<Draw>(&work)) {
    for (const std::string& color : draw->colors) add(color, {}, {});
    if (!draw->depth.empty()) add(draw->depth, {}, {});
  }
  return used;
}

KernelInterface kernel_interface(const Plan& plan, int stage_index, int work_index, const DeviceTraits& traits) {
  const PlannedStage& stage = plan.stages[static_cast<std::size_t>(stage_index)];
  const Work& work = stage.spec.work[static_cast<std::size_t>(work_index)];
  KernelInterface interface;
  std::string& text = interface.declarations;
  text += parameter_declarations(plan, stage);

  int texture_units = 0, image_units = 0, uniform_blocks = first_uniform_binding;
  const auto* draw = std::get_if<Draw>(&work);
  for (const UsedPort& used : used_ports(stage, work)) {
    const Port& port = stage.spec.ports[static_cast<std::size_t>(used.port)];
    const PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(stage.buffers[static_cast<std::size_t>(used.port)])];
    PortBinding binding{used.port, used.usage, buffer.texture, 0};
    switch (used.usage) {
      case Usage::storage:
        binding.binding = interface.storage_blocks++;
        text += storage_declaration(port, used.access, binding.binding, traits);
        break;
      case Usage::uniform:
        binding.binding = uniform_blocks++;
        text += uniform_declaration(port, buffer, binding.binding);
        break;
      case Usage::sampled:
        binding.binding = texture_units++;
        text += sampled_declaration(port, buffer, binding.binding);
        break;
      case Usage::image:
        binding.binding = image_units++;
        text += image_declaration(port, used.access, binding.binding);
        break;
      case Usage::framebuffer:
        if (draw == nullptr) break;
        if (const auto color = std::ranges::find(draw->colors, port.name); color != draw->colors.end())
          text += fmt::format("#ifdef FIRN_FRAGMENT\nlayout(location = {}) out vec4 {};\n#endif\n", color - draw->colors.begin(),
                              port.name);
        break;
      case Usage::vertex:
      case Usage::indirect:
      case Usage::transfer:
      case Usage::host:
        break;
    }
    interface.ports.push_back(binding);
  }
  for (const Port& port : stage.spec.ports)
    if (port.optional) {
      const bool used = std::ranges::any_of(interface.ports, [&](const PortBinding& b) {
        return stage.spec.ports[static_cast<std::size_t>(b.port)].name == port.name;
      });
      text += fmt::format("#define HAS_{} {}\n", upper(port.name), used ? 1 : 0);
    }
  if (!stage.spec.faults.empty()) {
    interface.fault_binding = interface.storage_blocks++;
    text += fault_declarations(interface.fault_binding, stage_index);
  }
  return interface;
}

std::string compute_prelude(const Plan& plan, int stage, int work, const DeviceTraits& traits) {
  const PlannedStage& planned = plan.stages[static_cast<std::size_t>(stage)];
  const auto& dispatch = std::get<Dispatch>(planned.spec.work[static_cast<std::size_t>(work)]);
  return fmt::format(
      "{}\n{}layout(local_size_x = {}) in;\n{}"
      "uint group_number() {{ return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }}\n"
      "uint element_index() {{ return group_number() * gl_WorkGroupSize.x + gl_LocalInvocationID.x; }}\n",
      traits.version_directive, extension_lines(traits, planned), dispatch.group,
      kernel_interface(plan, stage, work, traits).declarations);
}

std::string draw_prelude(const Plan& plan, int stage, int work, bool fragment, const DeviceTraits& traits) {
  return fmt::format("{}\n{}{}{}", traits.version_directive, extension_lines(traits, plan.stages[static_cast<std::size_t>(stage)]),
                     fragment ? "#define FIRN_FRAGMENT 1\n" : "", kernel_interface(plan, stage, work, traits).declarations);
}

std::vector<std::byte> parameter_block(const Plan& plan, int stage) {
  std::vector<std::byte> bytes;
  for (const Member& member : block_members(plan, plan.stages[static_cast<std::size_t>(stage)])) {
    if (components(member.type) == 3) {
      bytes.resize((bytes.size() + 15) / 16 * 16);
      for (const double part : std::get<Vector3>(member.value)) append_scalar(bytes, member.type, part);
    } else {
      append_scalar(bytes, member.type, real(member.value));
    }
  }
  bytes.resize((bytes.size() + 15) / 16 * 16);
  return bytes;
}

}  // namespace firn::graph
