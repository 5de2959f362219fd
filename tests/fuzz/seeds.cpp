// Writes what the fuzzers start from: everything that comes with Firn, the bad files of the other tests, and the words of the
// formats.
//   fuzz_seeds FOLDER  ->  FOLDER/pipeline, FOLDER/scene, ..., FOLDER/manifest; FOLDER/pipeline.dict and so on

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

std::string npy(const std::string& kind, const std::string& shape, const std::string& data) {
  const std::string header = "{'descr': '" + kind + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + std::string(1, '\0') + header + data;
}

// What scenes name and runs leave, small and good.
void write_files(const fs::path& folder) {
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n", faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const std::string twelve_floats = std::string("\0\0\x80\x3f", 4) + std::string(44, '\0');
  write(folder / "array" / "points.npy", npy("<f4", "(2, 6)", twelve_floats));
  write(folder / "array" / "map.npy", npy("<f8", "(2, 3)", twelve_floats));
  write(folder / "array" / "whole.npy", npy("<i4", "(12,)", twelve_floats));
  write(folder / "image" / "floats.f32", twelve_floats.substr(0, 36));
  // 2 x 2 pixels of grey in 8 bits.
  const std::string png_head("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x02\0\0\0\x02\x08\0\0\0\0\x57\xdd\x52\xf8", 33);
  const std::string png_data("\0\0\0\x0eIDAT\x78\x9c\x63\x60\x64\x62\x60\x66\x01\0\0\x1d\0\x0b\x0d\xb5\x52\x06", 26);
  write(folder / "image" / "grey.png", png_head + png_data + std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12));
  write(folder / "mesh" / "tetrahedron.obj", "ov 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const std::string head =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\nproperty list uchar int "
      "vertex_indices\nend_header\n";
  write(folder / "mesh" / "text.ply", "pply\nformat ascii 1.0\n" + head + corners + faces);
  std::string binary = "pply\nformat binary_little_endian 1.0\n" + head + twelve_floats;
  for (int face = 0; face < 4; ++face) binary += std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
  write(folder / "mesh" / "binary.ply", binary);
  write(folder / "stl" / "text.stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n");
  write(folder / "stl" / "binary.stl", std::string(80, ' ') + std::string("\1\0\0\0", 4) + std::string(12, '\0') +
                                           twelve_floats.substr(0, 36) + std::string(2, '\0'));
  const std::string inputs =
      R"({"pipeline": "mpm_snow", "scene": "", "set": ["k=1"], "disable": [], "replace": [], "image": "64x64", "share_memory": true, )"
      R"("repeats": "auto", "device": "auto", "barriers": "derived", "dump": ["position=p.npy"], "checkpoint_every": 5, )"
      R"("keep_checkpoints": 3, "started_in": "/", "steps": 4})";
  const std::string pipeline =
      R"({"name": "a", "stages": [{"stage": "mpm.seed", "parameters": {"a": [1, 2]}, "buffers": {"b": "c"}}], "step": [1]})";
  write(folder / "manifest" / "run.json",
        R"({"inputs": )" + inputs + R"(, "outputs": {"video.mp4": "00"}, "pipeline": )" + pipeline +
            R"(, "scene": {"resolved": "firn: 1\nname: a\n"}, "files": {"a": "b"}, "sizes": {"particles": 3}, "shaders": {}})");
  write(folder / "checkpoint" / "manifest",
        R"(m{"format": "firn checkpoint", "version": 1, "step": 4, "frame": 1, "time": 0.5, "dt": 0.1, "identity": {"pipeline": )" +
            pipeline + R"(}, "inputs": )" + inputs + R"(, "buffers": [{"name": "position"}]})");
  write(folder / "checkpoint" / "list", "h" + std::string(64, '0') + "  manifest.json\n");
  write(folder / "checkpoint" / "array", "a\x28\xb5\x2f\xfd");
  write(folder / "checkpoint" / "plain", "p" + npy("<f4", "(4, 3)", twelve_floats));
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    std::puts("usage: fuzz_seeds FOLDER");
    return 2;
  }
  const fs::path folder = words[1], shipped = fs::path(FIRN_SOURCE_DIR) / "pipelines";
  for (const char* target : {"pipeline", "scene", "stage", "array", "image", "mesh", "stl", "checkpoint", "manifest"})
    fs::create_directories(folder / target);
  write_files(folder);
  copy(shipped, ".yaml", folder / "pipeline");
  copy(shipped / "examples", ".yaml", folder / "pipeline");
  copy(shipped / "scenes", ".yaml", folder / "scene");
  copy(shipped / "examples", ".comp", folder / "stage");
  write(folder / "stage" / "whole_head.comp", whole_head);
  for (const char* kind : {"pipeline", "scene"})
    write_dictionary(folder / (std::string(kind) + ".dict"), words_of_schema(shipped / "schema" / (std::string(kind) + ".json")));
  write_dictionary(folder / "stl.dict", {"solid ", "endsolid ", "facet normal 0 0 0\\x0a", "outer loop\\x0a", "vertex 0 0 1\\x0a",
                                         "vertex 1 0 0\\x0a", "endloop\\x0a", "endfacet\\x0a", "nan", "-inf", "1e39"});
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
