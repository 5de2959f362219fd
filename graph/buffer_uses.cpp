#include "graph/buffer_uses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace firn::graph {
namespace {

// `anew`: only those that do not go on from what is there.
std::vector<std::string> stages_that_write(const std::string& buffer, const Registry& registry, bool anew = false) {
  std::vector<std::string> names;
  for (const auto& [name, type] : registry.all())
    if (std::ranges::any_of(type.spec.ports, [&](const Port& port) {
          return port.name == buffer && (anew ? port.access == Access::write : writes(port.access));
        }))
      names.push_back(name);
  return names;
}

void check_order(const PlannedBuffer& buffer, const std::vector<BufferUse>& uses, const Registry& registry,
                 config::Diagnostics& diagnostics) {
  const bool written = std::ranges::any_of(uses, [](const BufferUse& use) { return writes(use.access); });
  const bool read = std::ranges::any_of(
      uses, [](const BufferUse& use) { return use.access == Access::read || use.access == Access::read_write; });
  const BufferUse& first = uses.front();
  if (!written) {
    // Once per buffer, where it is named first; a disabled or missing writer is the usual reason.
    const std::vector<std::string> writers = stages_that_write(buffer.name, registry);
    diagnostics.error(buffer.place, fmt::format("{} reads '{}', which no stage of this pipeline writes{}", first.label, buffer.name,
                                                writers.empty() ? "; bind the port to another buffer, or add a stage that writes it"
                                                                : fmt::format("; {} would", fmt::join(writers, " or "))));
  } else if (first.usage == Usage::framebuffer && first.access != Access::write) {
    // Over a depth of zeros nothing can be drawn.
    const std::vector<std::string> writers = stages_that_write(buffer.name, registry, true);
    diagnostics.error(buffer.place,
                      fmt::format("{} draws into '{}', which no stage before it has begun{}", first.label, buffer.name,
                                  writers.empty() ? "" : fmt::format("; {} would", fmt::join(writers, " or "))));
  } else if (first.port_access == Access::read) {
    diagnostics.warning(buffer.place, fmt::format("{} reads '{}' before any stage has written it: at first it reads zeros",
                                                  first.label, buffer.name));
  }
  if (!read) diagnostics.warning(buffer.place, fmt::format("{} writes '{}', which no stage reads", first.label, buffer.name));
}

// Images are textures: no storage block, uniform block, vertex fetch or indirect command can have them.
void check_image(const std::string& buffer, const std::vector<BufferUse>& uses, config::Diagnostics& diagnostics) {
  constexpr std::array as_buffer{Usage::storage, Usage::uniform, Usage::vertex, Usage::indirect};
  for (const BufferUse& use : uses)
    if (std::ranges::find(as_buffer, use.usage) != as_buffer.end())
      diagnostics.error(use.place, fmt::format("{} uses '{}' as {}, but it is an image; bind the port to a buffer of its own",
                                               use.label, buffer, name(use.usage)));
}

}  // namespace

void check_buffers(const Plan& plan, const BufferUses& uses, const Registry& registry, config::Diagnostics& diagnostics) {
  for (const auto& [index, of_buffer] : uses) {
    const PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(index)];
    if (!plan.environment.provided.contains(buffer.name)) check_order(buffer, of_buffer, registry, diagnostics);
    if (buffer.texture) check_image(buffer.name, of_buffer, diagnostics);
  }
}

// A buffer that every step first writes as a whole, and that only steps touch, need not survive from one step to the next.
void lay_out_memory(Plan& plan, const BufferUses& uses) {
  for (int b = 0; b < static_cast<int>(plan.buffers.size()); ++b) {
    PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(b)];
    const auto of_buffer = uses.find(b);
    const bool written_first =
        of_buffer != uses.end() && of_buffer->second.front().in_every_step && of_buffer->second.front().access == Access::write;
    const bool only_steps = written_first && std::ranges::all_of(of_buffer->second, &BufferUse::in_step) &&
                            !plan.environment.provided.contains(buffer.name);
    buffer.lifetime = only_steps ? Lifetime::scratch : Lifetime::state;
    buffer.storage = b;
    plan.bytes += buffer.bytes;
  }
}

}  // namespace firn::graph
