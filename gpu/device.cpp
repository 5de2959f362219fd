#include "gpu/device.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <charconv>
#include <exception>
#include <optional>
#include <thread>

#include "gpu/context.h"

namespace firn::gpu {

struct Device::State {
  explicit State(const EglPlace& place) : context(place) {}
  Context context;
};

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::optional<std::size_t> as_index(const std::string& choice) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
  if (error != std::errc() || end != choice.data() + choice.size()) return std::nullopt;
  return index;
}

std::string listing(const std::vector<EglPlace>& places) {
  std::string text;
  for (std::size_t index = 0; index < places.size(); ++index) text += fmt::format("\n  {}: {}", index, places[index].where);
  return text;
}

// Empty where `info` is what `choice` asks for, else why not.
std::string mismatch(const DeviceInfo& info, const std::string& choice) {
  if (choice == "auto") return "";
  if (choice == "software") return info.software ? "" : fmt::format("{} is hardware", info.name);
  if (choice == "hardware") return info.software ? fmt::format("{} is a software renderer", info.name) : "";
  const bool named = lower(info.name).find(lower(choice)) != std::string::npos;
  return named ? "" : fmt::format("its name is {}", info.name);
}

}  // namespace

Device::Device(std::unique_ptr<State> state) : state_(std::move(state)) {}
Device::~Device() = default;

std::unique_ptr<Device> Device::open(const std::string& choice) {
  std::vector<EglPlace> places = egl_places();
  const auto opened = [](const EglPlace& place) { return std::unique_ptr<Device>(new Device(std::make_unique<State>(place))); };

  if (const auto index = as_index(choice)) {
    if (*index >= places.size()) {
      throw DeviceError(fmt::format("there is no device {}; the devices are:{}", *index, listing(places)));
    }
    try {
      return opened(places[*index]);
    } catch (const DeviceError& error) {
      throw DeviceError(fmt::format("device {} ({}) cannot be used: {}", *index, places[*index].where, error.what()));
    }
  }

  // The kind looked for is tried first, so that no other device need be opened. Software is told for sure only by an open context.
  std::stable_partition(places.begin(), places.end(),
                        [&](const EglPlace& place) { return place.says_software == (choice == "software"); });
  std::unique_ptr<Device> software;
  std::string tried;
  for (const EglPlace& place : places) {
    if (choice == "auto" && software && place.says_software) continue;
    try {
      std::unique_ptr<Device> device = opened(place);
      const std::string problem = mismatch(device->info(), choice);
      if (choice == "auto" && device->info().software) {
        // Kept while hardware is looked for.
        if (!software) software = std::move(device);
        continue;
      }
      if (problem.empty()) return device;
      tried += fmt::format("\n  {}: {}", place.where, problem);
    } catch (const DeviceError& error) {
      tried += fmt::format("\n  {}: {}", place.where, error.what());
    }
  }
  if (software) return software;
  if (places.empty()) tried = "\n  EGL lists no device, and no surfaceless platform";
  throw DeviceError(fmt::format("no OpenGL device for '{}'; tried:{}", choice, tried));
}

std::vector<Device::Candidate> Device::candidates() {
  std::vector<Candidate> found;
  for (const EglPlace& place : egl_places()) {
    Candidate candidate{place.where, {}, ""};
    try {
      candidate.info = Context(place).info;
    } catch (const DeviceError& error) {
      candidate.problem = error.what();
    }
    found.push_back(std::move(candidate));
  }
  return found;
}

const DeviceInfo& Device::info() const { return state_->context.info; }
bool Device::has(const std::string& extension) const { return info().extensions.contains(extension); }
std::string Device::version_directive() const { return fmt::format("#version {}{}0 core", info().major, info().minor); }
void Device::label(const char* text) { state_->context.label = text ? text : ""; }
void Device::check() const { state_->context.check_quickly(); }

void Device::finish() {
  glFinish();
  state_->context.check();
}

void Device::share_out(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& job) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failures(count);
  const auto take_some = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        job(i);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  finish();  // what other contexts are to see must be there
  std::vector<std::thread> others;
  for (unsigned i = 1; i < threads && i < count; ++i)
    others.emplace_back([&] {
      try {
        const Context context(&state_->context);
        take_some();
        glFinish();
      } catch (const std::runtime_error&) {
        // No further context is to be had: those that there are do its share.
      }
    });
  take_some();
  for (std::thread& other : others) other.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace firn::gpu
