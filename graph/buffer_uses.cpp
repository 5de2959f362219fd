#include "graph/buffer_uses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>

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

// From the first to the last place in a phase where a buffer is used. A repeat is one place: what one turn leaves, the next may
// read.
struct Life {
  int first = std::numeric_limits<int>::max(), last = -1;
  [[nodiscard]] bool meets(const Life& other) const { return first <= other.last && other.first <= last; }
};
using Lives = std::vector<Life>;  // by buffer

void extend(const std::vector<Op>& ops, std::optional<int> place, Lives& lives) {
  for (int at = 0; const Op& op : ops) {
    const int here = place.value_or(at++);
    const auto use = [&](int buffer) {
      Life& life = lives[static_cast<std::size_t>(buffer)];
      life.first = std::min(life.first, here);
      life.last = std::max(life.last, here);
    };
    if (const auto* run = std::get_if<Run>(&op.what))
      for (const BufferAccess& access : run->accesses) use(access.buffer);
    if (const auto* repeat = std::get_if<Repeat>(&op.what)) {
      extend(repeat->body, here, lives);
      if (repeat->until) use(repeat->until->buffer);
    }
  }
}

// Written as a whole before anything else in every phase that uses it, pictures not among them.
bool is_scratch(const std::vector<BufferUse>& uses) {
  const auto begun_anew = [&](Phase phase) {
    const auto first = std::ranges::find(uses, phase, &BufferUse::phase);
    return first == uses.end() || first->writes_all;
  };
  return begun_anew(Phase::setup) && begun_anew(Phase::step) && std::ranges::count(uses, Phase::step, &BufferUse::phase) > 0 &&
         std::ranges::count(uses, Phase::frame, &BufferUse::phase) == 0;
}

// Large buffers choose first, so that a storage is as large as its first buffer. Images keep a texture of their own.
void share_storage(Plan& plan) {
  Lives in_setup(plan.buffers.size()), in_step(plan.buffers.size());
  extend(plan.setup, {}, in_setup);
  extend(plan.step, {}, in_step);
  std::vector<int> order;
  for (int b = 0; b < static_cast<int>(plan.buffers.size()); ++b)
    if (const PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(b)];
        buffer.lifetime == Lifetime::scratch && !buffer.texture)
      order.push_back(b);
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](int b) { return plan.buffers[static_cast<std::size_t>(b)].bytes; });
  std::vector<std::vector<int>> storages;
  const auto meet = [&](int a, int b) {
    return std::ranges::any_of(std::array{&in_setup, &in_step}, [&](const Lives* lives) {
      return (*lives)[static_cast<std::size_t>(a)].meets((*lives)[static_cast<std::size_t>(b)]);
    });
  };
  for (const int b : order) {
    const auto free = std::ranges::find_if(storages, [&](const std::vector<int>& members) {
      return std::ranges::none_of(members, [&](int m) { return meet(m, b); });
    });
    std::vector<int>& members = free == storages.end() ? storages.emplace_back() : *free;
    members.push_back(b);
    plan.buffers[static_cast<std::size_t>(b)].storage = members.front();
  }
}

}  // namespace

void check_buffers(const Plan& plan, const BufferUses& uses, const Registry& registry, config::Diagnostics& diagnostics) {
  for (const auto& [index, of_buffer] : uses) {
    const PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(index)];
    if (!plan.environment.provided.contains(buffer.name)) check_order(buffer, of_buffer, registry, diagnostics);
    if (buffer.texture) check_image(buffer.name, of_buffer, diagnostics);
  }
}

bool writes_all(const Work& work, const Port& port, Access access) {
  if (access != Access::write) return false;
  const auto* dispatch = std::get_if<Dispatch>(&work);
  if (dispatch == nullptr) return std::holds_alternative<HostWork>(work);
  const bool few = !port.domain.empty() && port.domain.find_first_not_of("0123456789") == std::string::npos;
  const bool several_each = port.domain.starts_with(dispatch->over + "*");
  return dispatch->indirect.empty() && !dispatch->over.empty() && (dispatch->over == port.domain || several_each || few);
}

void lay_out_memory(Plan& plan, const BufferUses& uses, bool share) {
  for (int b = 0; b < static_cast<int>(plan.buffers.size()); ++b) {
    PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(b)];
    const auto of_buffer = uses.find(b);
    const bool scratch =
        of_buffer != uses.end() && is_scratch(of_buffer->second) && !plan.environment.provided.contains(buffer.name);
    buffer.lifetime = scratch ? Lifetime::scratch : Lifetime::state;
    buffer.storage = b;
  }
  if (share) share_storage(plan);
  std::map<int, std::uint64_t> bytes;
  for (const PlannedBuffer& buffer : plan.buffers) bytes[buffer.storage] = std::max(bytes[buffer.storage], buffer.bytes);
  plan.bytes = 0;
  for (const auto& [storage, size] : bytes) plan.bytes += size;
}

}  // namespace firn::graph
