#pragma once

// Files that are not what they should be, and scenes that name them.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace firn::test {

enum class Use { snow, body, points, depth };

struct BadFile {
  const char* what;
  const char* name;
  std::string bytes;
  Use use;
  const char* says;
};

template <typename T>
std::string raw(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

inline std::string ply(const std::string& vertices, const std::string& faces, const std::string& data,
                       const std::string& format = "ascii") {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n" + data;
}

inline std::string npy(const std::string& shape, const std::string& data, const std::string& kind = "<f4") {
  std::string header = "{'descr': '" + kind + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header + data;
}

// A PNG header of this size, and nothing behind it. Its checksum is left to libpng to complain of.
inline std::string png_start(std::uint32_t width, std::uint32_t height, unsigned char depth) {
  std::string bytes("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  for (const std::uint32_t n : {width, height})
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(n >> shift & 255);
  return bytes + std::string{static_cast<char>(depth), 0, 0, 0, 0} + std::string(4, '\x11');
}

inline std::vector<BadFile> bad_files() {
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n", faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const std::string nan = raw<float>({0, 0, 0, NAN, 0, 0, 0, 1, 0, 0, 0, 1}),
                    ones = raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  std::string binary_faces;
  for (const auto& f : {std::vector<std::int32_t>{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) binary_faces += '\3' + raw(f);
  const std::string little = "binary_little_endian";
  std::string stl(80, 'x');
  stl += raw<std::uint32_t>({4000000000U}) + std::string(50, '\0');
  return {
      {"empty obj", "a.obj", "", Use::snow, ""},
      {"only comments", "a.obj", "# nothing\n", Use::snow, ""},
      {"corners, no faces", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", Use::snow, ""},
      {"a face of corners that are not there", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", Use::snow, ""},
      {"NaN in obj", "a.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", Use::body, "finite"},
      {"infinity in obj", "a.obj", "v inf 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", Use::snow, "finite"},
      {"all faces without area", "a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", Use::snow, "no triangles with an area"},
      {"a program as obj", "a.obj",
       std::string("\x7f"
                   "ELF\0\0\1\2",
                   8) +
           std::string(200, '\xfe'),
       Use::snow, ""},
      {"empty ply", "a.ply", "", Use::snow, "end_header"},
      {"ply cut in its header", "a.ply", "ply\nformat ascii 1.0\nelement ver", Use::snow, "end_header"},
      {"ply with another magic", "a.ply", "plx" + ply("4", "4", corners + faces).substr(3), Use::snow, ""},
      {"ply that promises billions of corners", "a.ply", ply("4000000000", "4", corners + faces), Use::snow, "promises"},
      {"binary ply that promises billions of faces", "a.ply", ply("4", "3000000000", ones + binary_faces, little), Use::body,
       "promises"},
      {"ply of more than 64 bits", "a.ply", ply("99999999999999999999999", "4", corners + faces), Use::snow, "promises"},
      {"binary ply cut in its corners", "a.ply", ply("4", "4", ones.substr(0, 20), little), Use::snow, "promises"},
      {"binary ply cut in its faces", "a.ply", ply("4", "4", ones + binary_faces.substr(0, 5), little), Use::snow, ""},
      {"binary ply with NaN", "a.ply", ply("4", "4", nan + binary_faces, little), Use::snow, "finite"},
      {"ply without faces", "a.ply", ply("4", "0", corners), Use::snow, ""},
      {"ply whose faces name corners beyond", "a.ply", ply("4", "1", corners + "3 0 1 77\n"), Use::snow, ""},
      {"empty stl", "a.stl", "", Use::snow, "has 0 bytes"},
      {"stl that promises billions of faces", "a.stl", stl, Use::snow, "promises 4000000000 triangles"},
      {"stl of text cut off", "a.stl", "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0", Use::body, "line 4"},
      {"a mesh of another kind", "a.fbx", "Kaydara", Use::snow, "an .obj, .ply or .stl file"},
      {"empty npy", "a.npy", "", Use::points, ".npy"},
      {"npy with another magic", "a.npy", "\x93NUMPX" + npy("(1, 3)", std::string(12, '\0')).substr(6), Use::points, ".npy"},
      {"npy cut off", "a.npy", npy("(1000, 3)", std::string(40, '\0')), Use::points, "cut off"},
      {"npy of a huge shape", "a.npy", npy("(4000000000, 3)", std::string(40, '\0')), Use::points, "cut off"},
      {"npy of a shape beyond counting", "a.npy", npy("(4000000000, 4000000000, 3)", ""), Use::points, "counted"},
      {"npy of objects", "a.npy", npy("(1,)", "x", "|O"), Use::points, "type"},
      {"npy with NaN", "a.npy", npy("(1, 3)", raw<float>({0, NAN, 0})), Use::points, "finite"},
      {"npy of no points", "a.npy", npy("(0, 3)", ""), Use::points, "no points"},
      {"npy of another shape", "a.npy", npy("(3,)", std::string(12, '\0')), Use::points, "shape"},
      {"empty png", "a.png", "", Use::depth, "no PNG"},
      {"a jpeg called png", "a.png", "\xff\xd8\xff\xe0" + std::string(100, 'j'), Use::depth, "no PNG"},
      {"png cut after its header", "a.png", png_start(64, 64, 16), Use::depth, "broken"},
      {"png of a huge size", "a.png", png_start(2000000000, 2000000000, 16), Use::depth, ""},
      {"floats that make no square", "a.f32", std::string(4 * 10, '\0'), Use::depth, "square"},
      {"half a float", "a.f32", std::string(66, '\0'), Use::depth, "66 bytes"},
      {"floats with NaN", "a.f32", raw<float>({1, 2, NAN, 4}), Use::depth, "finite"},
      {"an array of three dimensions as a map", "a.npy", npy("(1, 1, 1)", std::string(4, '\0')), Use::depth, "two dimensions"},
      {"an array with infinity as a map", "a.npy", npy("(1, 2)", raw<float>({1, INFINITY})), Use::depth, "finite"},
  };
}

inline std::string scene_with(Use use, const std::string& name) {
  const std::string start = "firn: 1\ndomain: {min: [-1, -1, -1], max: [1, 1, 1], cell: 0.1}\nmaterials: {m: {preset: packed}}\n";
  const std::string ball = "snow: [{sphere: {center: [0, 0, 0], radius: 0.2}, material: m}]\n";
  switch (use) {
    case Use::snow:
      return start + "snow: [{mesh: {file: \"" + name + "\", scale: 0.5}, material: m}]\n";
    case Use::points:
      return start + "snow: [{points: {file: \"" + name + "\", mass: 1}, material: m}]\n";
    case Use::body:
      return start + ball + "bodies: [{mesh: {file: \"" + name + "\"}}]\n";
    default:
      return start + "field: {size: [1, 1], cells: [8, 8], material: new_snow, depth: {image: \"" + name + "\", metres: 1}}\n";
  }
}

}  // namespace firn::test
