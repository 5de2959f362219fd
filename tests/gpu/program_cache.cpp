// Programs on disk: found again, never trusted, never too many; and programs of several contexts.

#include "gpu/program_cache.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>

#include "tests/gpu/support.h"

using namespace firn::gpu;
using namespace firn::test;
namespace fs = std::filesystem;

namespace {

const std::string key = digest("some source");
const std::string other_key = digest("another source");

ProgramCache::Entry entry_of(std::size_t bytes, unsigned char value = 7) {
  return {0x1234, std::vector<std::byte>(bytes, static_cast<std::byte>(value))};
}

fs::path only_file(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& file : fs::directory_iterator(folder)) files.push_back(file.path());
  REQUIRE(files.size() == 1);
  return files[0];
}

std::string read_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}
void write_file(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

ProgramSource adding(const Device& device, int number) {
  const std::string text =
      "layout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer Data { int value; };\nvoid main() { value += " +
      std::to_string(number) + "; }\n";
  return {{{ShaderKind::compute, with_version(device, text)}}, "adds " + std::to_string(number)};
}

int result_of(const Program& program) {
  const Buffer buffer = buffer_of<std::int32_t>({0});
  use(program);
  bind_storage(0, buffer);
  dispatch(1, 1, 1);
  return contents<std::int32_t>(buffer)[0];
}

bool hands_out_programs(const Device& device) {
  if (device.info().program_binary_formats == 0) WARN("skipped: this driver hands out no compiled programs");
  return device.info().program_binary_formats > 0;
}

}  // namespace

TEST_CASE("digests are SHA-256") {
  CHECK(digest("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(digest("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("what is stored is found under its own key only") {
  const TemporaryFolder folder;
  const ProgramCache cache(folder.path() / "made" / "when needed");
  CHECK_FALSE(cache.find(key));
  cache.store(key, entry_of(1000));
  const auto found = cache.find(key);
  REQUIRE(found);
  CHECK(found->format == 0x1234);
  CHECK(found->binary == entry_of(1000).binary);
  CHECK_FALSE(cache.find(other_key));
  CHECK(cache.size().entries == 1);
  CHECK(cache.size().bytes > 1000);
}

TEST_CASE("an entry that is cut off, damaged or of another program is none, told, and removed") {
  const TemporaryFolder folder;
  std::vector<std::string> told;
  const ProgramCache cache(folder.path(), [&](const std::string& text) { told.push_back(text); });
  cache.store(key, entry_of(1000));
  const fs::path file = only_file(folder.path());
  const std::string whole = read_file(file);
  SECTION("cut off anywhere") {
    for (const std::size_t length :
         {std::size_t{0}, std::size_t{5}, std::size_t{40}, std::size_t{100}, whole.size() / 2, whole.size() - 1}) {
      write_file(file, whole.substr(0, length));
      CHECK_FALSE(cache.find(key));
      CHECK_FALSE(fs::exists(file));
    }
    CHECK(told.size() == 6);
  }
  SECTION("any bit the other way") {
    for (std::size_t at = 0; at < whole.size(); at += 7) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ 4);
      write_file(file, damaged);
      INFO("byte " << at);
      CHECK_FALSE(cache.find(key));
    }
  }
  SECTION("longer than it was") {
    write_file(file, whole + "x");
    CHECK_FALSE(cache.find(key));
  }
  SECTION("of another program") {
    fs::rename(file, folder.path() / (other_key + file.extension().string()));
    CHECK_FALSE(cache.find(other_key));
    CHECK(told.size() == 1);
    contains(told.at(0), "another program");
  }
}

TEST_CASE("a folder that cannot be written to stores nothing and fails nothing") {
  const TemporaryFolder folder;
  write_file(folder.path() / "file", "");
  std::vector<std::string> told;
  const ProgramCache cache(folder.path() / "file" / "below", [&](const std::string& text) { told.push_back(text); });
  cache.store(key, entry_of(10));
  CHECK_FALSE(cache.find(key));
  cache.trim();
  CHECK(cache.size().entries == 0);
  CHECK(told.size() == 1);
}

TEST_CASE("those not used for longest go, and nothing that is not ours") {
  const TemporaryFolder folder;
  const ProgramCache cache(folder.path(), {}, 10'000);
  std::vector<std::string> keys;
  for (int i = 0; i < 12; ++i) {
    keys.push_back(digest(std::to_string(i)));
    cache.store(keys.back(), entry_of(1000));
    const fs::path file = folder.path() / (keys.back() + ".program");
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(100 - i));
  }
  const fs::path foreign = folder.write("notes.program", std::string(100'000, 'x'));
  const fs::path half = folder.write(keys[0] + ".0123.0.unfinished", "x"), dead = folder.write(keys[0] + ".4567.0.unfinished", "x");
  fs::last_write_time(dead, fs::file_time_type::clock::now() - std::chrono::hours(2));
  CHECK(cache.find(keys[1]));  // used just now
  cache.trim();
  CHECK(cache.size().bytes <= 10'000);
  CHECK(cache.size().entries >= 5);
  CHECK_FALSE(cache.find(keys[0]));
  CHECK(cache.find(keys[1]));
  CHECK_FALSE(cache.find(keys[2]));
  CHECK(cache.find(keys[11]));
  CHECK(fs::exists(foreign));
  CHECK(fs::exists(half));  // somebody may be writing it
  CHECK_FALSE(fs::exists(dead));
  const std::size_t left = cache.size().entries;
  cache.trim();
  CHECK(cache.size().entries == left);
}

TEST_CASE("processes that store, read and trim at once see whole entries or none") {
  const TemporaryFolder folder;
  constexpr int processes = 6;
  std::vector<pid_t> children;
  for (int process = 0; process < processes; ++process) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      std::atomic<bool> damaged{false};
      const ProgramCache cache(
          folder.path(), [&](const std::string&) { damaged = true; }, 20'000);
      for (int i = 0; i < 300; ++i) {
        const std::string name = digest(std::to_string(i % 5));
        const auto found = cache.find(name);
        if (found && found->binary.size() != static_cast<std::size_t>(5000 + i % 5)) damaged = true;
        cache.store(name, entry_of(5000 + i % 5, static_cast<unsigned char>(process)));
        if (found) {
          const std::set<std::byte> values(found->binary.begin(), found->binary.end());
          if (values.size() != 1) damaged = true;
        }
      }
      _exit(damaged ? 1 : 0);
    }
    children.push_back(child);
  }
  const ProgramCache trimming(folder.path(), {}, 20'000);
  for (int i = 0; i < 50; ++i) trimming.trim();
  for (const pid_t child : children) {
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK((WIFEXITED(status) && WEXITSTATUS(status) == 0));
  }
  for (const auto& file : fs::directory_iterator(folder.path())) CHECK(file.path().extension() == ".program");
}

TEST_CASE("a program from the cache does the same, and another source or another shader is another program") {
  const auto device = Device::open();
  if (!hands_out_programs(*device)) return;
  const TemporaryFolder folder;
  const ProgramCache cache(folder.path());
  const std::array sources = {adding(*device, 3), adding(*device, 4)};
  CHECK_FALSE(cached_program(sources[0], cache));
  const std::vector<Program> compiled = compile_programs(sources, &cache);
  CHECK(cache.size().entries == 2);
  for (int i = 0; i < 2; ++i) {
    const auto again = cached_program(sources[i], cache);
    REQUIRE(again);
    CHECK(result_of(compiled[i]) == 3 + i);
    CHECK(result_of(*again) == 3 + i);
  }
  CHECK_FALSE(cached_program(adding(*device, 5), cache));
  ProgramSource as_vertex_shader = sources[0];
  as_vertex_shader.shaders[0].first = ShaderKind::vertex;
  CHECK_FALSE(cached_program(as_vertex_shader, cache));
}

TEST_CASE("a program that the driver does not take is compiled anew") {
  const auto device = Device::open();
  if (!hands_out_programs(*device)) return;
  const TemporaryFolder folder;
  std::vector<std::string> told;
  const ProgramCache cache(folder.path(), [&](const std::string& text) { told.push_back(text); });
  const ProgramSource source = adding(*device, 3);
  compile_programs(std::span(&source, 1), &cache);
  const std::string its_key = only_file(folder.path()).stem().string();
  ProgramCache::Entry entry = cache.find(its_key).value();
  SECTION("of an unknown format") { entry.format = 0xfff0; }
  SECTION("of another build of the driver") {
    for (std::byte& byte : entry.binary) byte ^= std::byte{0x55};
  }
  SECTION("cut off before it was stored") { entry.binary.resize(entry.binary.size() / 2); }
  cache.store(its_key, entry);
  CHECK_FALSE(cached_program(source, cache));
  CHECK_NOTHROW(device->check());
  CHECK(told.size() == 1);
  CHECK(cache.size().entries == 0);
  CHECK(result_of(compile_programs(std::span(&source, 1), &cache).front()) == 3);
  CHECK(cached_program(source, cache));
}

TEST_CASE("a driver that hands out no programs leaves the cache empty", "[.no-programs]") {
  const auto device = Device::open();
  const TemporaryFolder folder;
  const ProgramCache cache(folder.path());
  const ProgramSource source = adding(*device, 3);
  CHECK(result_of(compile_programs(std::span(&source, 1), &cache).front()) == 3);
  CHECK_FALSE(cached_program(source, cache));
  CHECK(cache.size().entries == 0);
  WARN("formats: " << device->info().program_binary_formats);
}

TEST_CASE("without its own cache Mesa hands out no programs, and they are compiled each time") {
  const std::string output = output_of_own_process("MESA_SHADER_CACHE_DISABLE=true", "[.no-programs]");
  if (output.find("formats: 0") == std::string::npos) WARN("another driver than Mesa");
  contains(output, "All tests passed");
}

TEST_CASE("errors of all programs that do not compile are told at once") {
  const auto device = Device::open();
  std::array sources = {adding(*device, 1), adding(*device, 2), adding(*device, 3)};
  sources[0].shaders[0].second.text += "first_error";
  sources[2].shaders[0].second.text += "second_error";
  const std::string message = message_of<ShaderError>([&] { compile_programs(sources, nullptr); });
  contains(message, "'adds 1' does not compile");
  contains(message, "'adds 3' does not compile");
  CHECK(message.find("'adds 2'") == std::string::npos);
  CHECK_NOTHROW(device->check());
}

TEST_CASE("work is shared out to contexts that see the same objects") {
  const auto device = Device::open();
  constexpr std::size_t count = 24;
  std::vector<ProgramSource> sources;
  for (std::size_t i = 0; i < count; ++i) sources.push_back(adding(*device, static_cast<int>(i)));
  std::vector<Program> programs(count);
  std::vector<int> results(count);
  const Buffer shared = buffer_of<std::int32_t>({100});
  std::mutex lock;
  std::set<std::thread::id> threads;
  device->share_out(count, 4, [&](std::size_t i) {
    programs[i] = std::move(compile_programs(std::span(&sources[i], 1), nullptr).front());
    results[i] = result_of(programs[i]);  // bound in this context only
    const std::lock_guard guard(lock);
    threads.insert(std::this_thread::get_id());
  });
  CHECK((threads.size() >= 1 && threads.size() <= 4));
  for (std::size_t i = 0; i < count; ++i) {
    CHECK(results[i] == static_cast<int>(i));
    CHECK(result_of(programs[i]) == static_cast<int>(i));
  }
  CHECK(contents<std::int32_t>(shared)[0] == 100);
  CHECK_NOTHROW(device->check());
}

TEST_CASE("what fails in work that is shared out is thrown once all is done, the first of it") {
  const auto device = Device::open();
  const unsigned threads = GENERATE(1u, 3u);
  CAPTURE(threads);
  std::atomic<int> done{0};
  const std::string message = message_of<std::runtime_error>([&] {
    device->share_out(16, threads, [&](std::size_t i) {
      ++done;
      if (i == 5 || i == 11) throw std::runtime_error("number " + std::to_string(i));
    });
  });
  CHECK(message == "number 5");
  CHECK(done == 16);
  CHECK_NOTHROW(device->share_out(0, threads, [](std::size_t) {}));
}
