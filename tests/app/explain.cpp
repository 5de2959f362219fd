#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "graph/barriers.h"
#include "tests/app/inputs.h"
#include "tests/catch.h"
#include "tests/graph/memory_model.h"

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::run_firn;
using nlohmann::json;

namespace {

constexpr const char* pipelines[] = {"mpm_snow", "mpm_thesis", "heightfield_contour", "heightfield_distance"};

json explained(const std::string& pipeline, const firn::test::Words& more = {}) {
  firn::test::Words words{"explain", pipeline, "--format", "json"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = run_firn(words);
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  return json::parse(outcome.out);
}

std::set<std::string> keys(const json& object) {
  std::set<std::string> names;
  for (const auto& [key, value] : object.items()) names.insert(key);
  return names;
}

// A plan out of nothing but the JSON, as somebody else's checker would read it.
class ReadPlan {
 public:
  explicit ReadPlan(const json& text) {
    std::map<std::string, int> memories;
    for (const json& buffer : text.at("buffers")) {
      CHECK(keys(buffer) == std::set<std::string>{"name", "type", "domain", "bytes", "lifetime", "storage"});
      firn::graph::PlannedBuffer& read = plan.buffers.emplace_back();
      read.name = buffer.at("name");
      read.storage = memories.emplace(buffer.at("storage").get<std::string>(), static_cast<int>(memories.size())).first->second;
      read.bytes = buffer.at("bytes").get<std::uint64_t>();
    }
    plan.setup = ops(text.at("phases").at("setup"));
    plan.step = ops(text.at("phases").at("step"));
    plan.frame = ops(text.at("phases").at("frame"));
  }

  firn::graph::Plan plan;
  int barriers = 0;

 private:
  std::vector<firn::graph::Op> ops(const json& list) {
    std::vector<firn::graph::Op> result;
    for (const json& op : list) {
      const std::string kind = op.at("op");
      if (kind == "barrier") {
        CHECK(keys(op) == std::set<std::string>{"op", "bits", "reasons"});
        CHECK_FALSE(op.at("reasons").empty());
        result.emplace_back().what = firn::graph::Barrier{bits(op.at("bits")), {}};
        ++barriers;
      } else if (kind == "repeat") {
        CHECK(keys(op) == std::set<std::string>{"op", "max", "body"});
        firn::graph::Repeat repeat;
        repeat.max = op.at("max").get<std::int64_t>();
        repeat.body = ops(op.at("body"));
        result.emplace_back().what = repeat;
      } else {
        CHECK((kind == "dispatch" || kind == "draw" || kind == "host"));
        CHECK(keys(op) == std::set<std::string>{"op", "stage", "kernel", "accesses"});
        firn::graph::Run run;
        run.stage = static_cast<int>(plan.stages.size());
        plan.stages.emplace_back().label = op.at("stage");
        for (const json& access : op.at("accesses")) run.accesses.push_back(read_access(access));
        result.emplace_back().what = run;
      }
    }
    return result;
  }

  static firn::graph::Bits bits(const json& names) {
    firn::graph::Bits result = 0;
    for (unsigned bit = 0; bit < 11; ++bit)
      if (std::find(names.begin(), names.end(), firn::graph::bit_names(1U << bit).front()) != names.end()) result |= 1U << bit;
    CHECK(firn::graph::bit_names(result).size() == names.size());
    return result;
  }

  firn::graph::BufferAccess read_access(const json& access) {
    CHECK(keys(access) == std::set<std::string>{"buffer", "access", "usage"});
    const int buffer = plan.buffer(access.at("buffer"));
    REQUIRE(buffer >= 0);
    const auto usage = firn::graph::usage(access.at("usage").get<std::string>());
    REQUIRE(usage);
    // Pictures are those that are drawn to or stored to as images.
    if (*usage == firn::graph::Usage::framebuffer || *usage == firn::graph::Usage::image)
      plan.buffers[static_cast<std::size_t>(buffer)].texture = true;
    return {buffer, firn::graph::access(access.at("access").get<std::string>()).value(), *usage};
  }
};

std::size_t hazards(const firn::graph::Plan& plan) {
  firn::test::MemoryModel model(plan);
  const firn::test::Choices choices{[](const firn::graph::Repeat& repeat) { return std::min<std::int64_t>(repeat.max, 3); },
                                    [](int) { return true; }};
  std::size_t found = 0;
  for (const char* phases : {"sssfsf", "fsfs", "ffss"})
    found += model.hazards(firn::test::trace(plan, phases, choices), false).size();
  return found;
}

// One by one, each barrier is taken out: then something must be missing.
bool each_is_needed(firn::graph::Plan& plan, std::vector<firn::graph::Op>& ops) {
  for (firn::graph::Op& op : ops) {
    if (auto* repeat = std::get_if<firn::graph::Repeat>(&op.what); repeat != nullptr && !each_is_needed(plan, repeat->body))
      return false;
    auto* barrier = std::get_if<firn::graph::Barrier>(&op.what);
    if (barrier == nullptr) continue;
    const firn::graph::Bits bits = std::exchange(barrier->bits, 0);
    const std::size_t without = hazards(plan);
    barrier->bits = bits;
    if (without == 0) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("the JSON of explain has the documented shape, and is enough to check every barrier by OpenGL's rules", "[app]") {
  for (const char* pipeline : pipelines)
    for (const char* who : {"host", "device"}) {
      CAPTURE(pipeline, who);
      const json text = explained(pipeline, {"--repeats", who});
      CHECK(keys(text) == std::set<std::string>{"pipeline", "phases", "buffers", "memory", "bindings", "unhindered", "forms"});
      CHECK(keys(text.at("forms")) == std::set<std::string>{"device", "assumed", "reason", "choices"});
      CHECK(keys(text.at("phases")) == std::set<std::string>{"setup", "step", "frame"});
      ReadPlan read(text);
      CHECK(read.barriers > 3);
      CHECK(hazards(read.plan) == 0);
      CHECK(each_is_needed(read.plan, read.plan.step));
      for (const json& access : text.at("unhindered")) CHECK_FALSE(access.at("why").get<std::string>().empty());
    }
}

TEST_CASE("explain tells which forms of kernels a device calls for, and which it has assumed", "[app]") {
  const auto forms = [](const firn::test::Words& more) {
    const json told = explained("mpm_snow", more).at("forms");
    std::set<std::string> values;
    for (const json& choice : told.at("choices")) {
      CHECK(keys(choice) == std::set<std::string>{"stage", "parameter", "value", "automatic"});
      values.insert(choice.at("value").get<std::string>() + (choice.at("automatic").get<bool>() ? "" : " (told)"));
    }
    CHECK(told.at("reason").get<std::string>().size() > 20);
    CHECK(told.at("assumed").get<bool>() == (more.empty() || more[1] != "auto"));
    return values;
  };
  using Values = std::set<std::string>;
  CHECK(forms({}) == Values{"texture", "by_cell"});
  CHECK(forms({"--device", "hardware"}) == Values{"shared", "by_block"});
  CHECK(forms({"--device", "subgroups"}) == Values{"subgroup", "by_block"});
  CHECK(forms({"--device", "hardware", "--set", "mpm.gather_velocities.form=texture"}) == Values{"texture (told)", "by_block"});
  const Outcome text = run_firn({"explain", "mpm_snow", "--device", "hardware"});
  CHECK(text.out.find("forms of kernels for hardware (assumed") != std::string::npos);
  CHECK(text.out.find("mpm/gather_block_sums.comp") != std::string::npos);
  CHECK(text.out.find("mpm/gather_pack.comp") == std::string::npos);
  // The one that runs here.
  CHECK_FALSE(forms({"--device", "auto"}).empty());
  CHECK(run_firn({"explain", "mpm_snow", "--device", "no such device"}).status == 3);
}

TEST_CASE("memory in explain is the sum of what buffers live in, each counted once", "[app]") {
  for (const char* pipeline : pipelines) {
    CAPTURE(pipeline);
    const auto total = [](const json& text) {
      std::map<std::string, std::uint64_t> largest;
      for (const json& buffer : text.at("buffers")) {
        std::uint64_t& bytes = largest[buffer.at("storage")];
        bytes = std::max(bytes, buffer.at("bytes").get<std::uint64_t>());
      }
      std::uint64_t sum = 0;
      for (const auto& [memory, bytes] : largest) sum += bytes;
      return sum;
    };
    const json shared = explained(pipeline), apart = explained(pipeline, {"--no-alias"});
    CHECK(shared.at("memory").at("bytes") == total(shared));
    CHECK(apart.at("memory").at("bytes") == total(apart));
    CHECK(apart.at("memory").at("without_sharing") == total(apart));
    CHECK(total(shared) < total(apart));
    for (const json& buffer : shared.at("buffers")) CHECK((buffer.at("lifetime") == "state" || buffer.at("lifetime") == "scratch"));
  }
}

TEST_CASE("explain tells phases, barriers with reasons, accesses that need none, lifetimes and memory as text", "[app]") {
  const Outcome outcome = run_firn({"explain", "heightfield_contour"});
  REQUIRE(outcome.status == 0);
  for (const char* fragment :
       {"heightfield_contour: Height-field snow", "\nsetup", "\nstep", "\nframe", "--- barrier: shader_storage",
        "because of overlap", "no barrier: written by heightfield.init, which OpenGL orders by itself",
        "repeat 4 times at most, until moved is below 1e-05", "scratch", "\nmemory: "}) {
    INFO(fragment);
    CHECK(outcome.out.find(fragment) != std::string::npos);
  }
  CHECK(outcome.out.find("NOT IN ORDER") == std::string::npos);
}

TEST_CASE("explain goes to a file where one is named, and refuses what it cannot write", "[app]") {
  const Folder folder;
  REQUIRE(run_firn({"explain", "mpm_thesis", "--format", "dot", "--out", folder / "plan.dot"}).status == 0);
  const std::string dot = firn::test::read_file(folder / "plan.dot");
  CHECK(dot.starts_with("digraph"));
  for (const char* part :
       {"cluster_setup", "cluster_step", "cluster_frame", "<b>mpm.advect</b>", "barrier: shader_storage", "grid_mass"})
    CHECK(dot.find(part) != std::string::npos);
  CHECK(run_firn({"explain", "mpm_thesis", "--out", folder / "nowhere/plan.txt"}).status == 1);
}

TEST_CASE("explain draws by Graphviz, and says in a sentence where that is not installed", "[app]") {
  const Folder folder;
  const Outcome without = run_firn({"explain", "mpm_thesis", "--format", "svg"}, {{"PATH", folder / "empty"}});
  CHECK(without.status == 1);
  CHECK(without.err.find("Graphviz") != std::string::npos);
  CHECK(without.out.empty());
  const Outcome with = run_firn({"explain", "mpm_thesis", "--format", "svg"});
  if (with.status == 1) {
    INFO(with.err);
    CHECK(with.err.find("not installed") != std::string::npos);  // nothing more can be tried here
    return;
  }
  CHECK(with.status == 0);
  CHECK(with.out.find("<svg") != std::string::npos);
  CHECK(with.out.find("mpm.advect") != std::string::npos);
}
