// Writes what the fuzzers start from: everything that comes with Firn, the bad files of the other tests, and the words of the
// formats.
//   fuzz_seeds FOLDER  ->  FOLDER/pipeline, FOLDER/scene, FOLDER/stage; FOLDER/pipeline.dict and so on

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/bad_tables.h"

namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

// In the sandbox all pipelines lie in one folder.
std::string without(std::string text, const std::string& part) {
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part)) text.erase(at, part.size());
  return text;
}

void copy(const fs::path& folder, const std::string& extension, const fs::path& to) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    constexpr std::size_t longest = 8192;
    if (entry.path().extension() != extension || entry.file_size() > longest) continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    write(to / entry.path().filename(), without({std::istreambuf_iterator<char>(stream), {}}, "../"));
  }
}

constexpr const char* whole_head = R"(/*
firn: 1
name: blur
doc: Smooths
equation: x' = x
ports:
  position: {type: vec3, domain: particles, access: read_write, unit: m, doc: a port}
  wind: {type: vec3, domain: particles, access: read, usage: sampled, unit: m/s, doc: another, optional: true}
  sum: {type: float, domain: "1", access: accumulate, unit: m, doc: a third}
parameters:
  radius: {default: 1.5, min: 0, max: 10, unit: m, doc: how far}
  turns: {kind: integer, default: 2, doc: how often}
  wrap: {kind: boolean, default: false, doc: whether}
  mode: {kind: choice, choices: [fine, coarse], default: fine, doc: which}
  push: {kind: vector3, default: [0, 1, 0], unit: m, doc: where to}
constants: [gravity]
faults: [not_a_number]
over: particles
group: 128
*/
void main() {}
)";

// The keys and choices of a schema.
void collect_words(const nlohmann::json& schema, std::set<std::string>& words) {
  if (!schema.is_structured()) return;
  for (const auto& [key, value] : schema.items()) {
    if (key == "properties")
      for (const auto& [name, ignored] : value.items()) words.insert(name + ":");
    if (key == "const" && value.is_string()) words.insert(value.get<std::string>());
    if (key == "enum")
      for (const auto& choice : value)
        if (choice.is_string()) words.insert(choice.get<std::string>());
    collect_words(value, words);
  }
}

void write_dictionary(const fs::path& file, std::set<std::string> words) {
  for (const char* more : {"&a ", "*a", "${", "- ", "{", "}", "[", "]", "!!str ", "|\\x0a", ".nan", "1e308", "\\x0a  "})
    words.insert(more);
  std::string text;
  for (const std::string& word : words)
    if (word.find_first_of("\"\n") == std::string::npos && word.size() < 60) text += "\"" + word + "\"\n";
  write(file, text);
}

std::set<std::string> words_of_schema(const fs::path& file) {
  std::set<std::string> words;
  std::ifstream stream(file);
  collect_words(nlohmann::json::parse(stream), words);
  return words;
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    std::puts("usage: fuzz_seeds FOLDER");
    return 2;
  }
  const fs::path folder = words[1], shipped = fs::path(FIRN_SOURCE_DIR) / "pipelines";
  for (const char* target : {"pipeline", "scene", "stage"}) fs::create_directories(folder / target);
  copy(shipped, ".yaml", folder / "pipeline");
  copy(shipped / "examples", ".yaml", folder / "pipeline");
  copy(shipped / "scenes", ".yaml", folder / "scene");
  copy(shipped / "examples", ".comp", folder / "stage");
  write(folder / "stage" / "whole_head.comp", whole_head);
  for (const char* kind : {"pipeline", "scene"})
    write_dictionary(folder / (std::string(kind) + ".dict"), words_of_schema(shipped / "schema" / (std::string(kind) + ".json")));
  write_dictionary(folder / "stage.dict",
                   {"ports:",    "parameters:", "type:",    "domain:",    "access:",    "usage:",      "unit:",        "doc:",
                    "optional:", "kind:",       "default:", "min:",       "max:",       "choices:",    "constants:",   "faults:",
                    "over:",     "group:",      "float",    "vec3",       "mat3",       "int",         "uint",         "texel",
                    "storage",   "uniform",     "sampled",  "image",      "read_write", "accumulate",  "write",        "read",
                    "number",    "integer",     "boolean",  "choice",     "vector3",    "gravity",     "not_a_number", "overflow",
                    "particles", "cells",       "nodes",    "bodies",     "cells*4",    "particles/3", "field_min",    "/*",
                    "*/",        "materials",   "image",    "shadow_map", "velocity",   "position",    "depth",        "density"});
  int number = 0;
  const auto spoilt = [&](const fs::path& to, const std::string& text, const std::vector<firn::test::Bad>& table) {
    for (const firn::test::Bad& bad : table)
      write(to / ("bad_" + std::to_string(number++) + ".yaml"), firn::test::spoil(text, bad).text);
  };
  spoilt(folder / "pipeline", firn::test::small_pipeline, firn::test::bad_pipelines());
  spoilt(folder / "scene", firn::test::small_scene, firn::test::bad_scenes());
  return 0;
}
