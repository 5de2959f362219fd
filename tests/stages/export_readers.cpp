#include "tests/stages/export_readers.h"

#include <zlib.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace firn::test {
namespace {

std::string base64(std::string_view text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> held & 255);
  }
  return bytes;
}

template <typename T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

// The header is encoded by itself: its first word tells its length.
std::string inflated(const std::string& text) {
  const auto blocks = at<std::uint32_t>(base64(text.substr(0, 8)), 0);
  const std::size_t header_bytes = (3 + blocks) * 4, header_text = (header_bytes + 2) / 3 * 4;
  const std::string header = base64(text.substr(0, header_text)), data = base64(text.substr(header_text));
  const auto length = at<std::uint32_t>(header, 4), last = at<std::uint32_t>(header, 8);
  std::string all;
  std::size_t from = 0;
  for (std::uint32_t b = 0; b < blocks; ++b) {
    const auto packed = at<std::uint32_t>(header, 12 + 4 * b);
    uLongf bytes = b + 1 == blocks && last > 0 ? last : length;
    std::string block(bytes, 0);
    const uLongf expected = bytes;
    if (uncompress(reinterpret_cast<Bytef*>(block.data()), &bytes, reinterpret_cast<const Bytef*>(data.data() + from), packed) !=
            Z_OK ||
        bytes != expected)
      throw std::runtime_error("a block cannot be inflated");
    all += block;
    from += packed;
  }
  if (from != data.size()) throw std::runtime_error("something follows the last block");
  return all;
}

std::string attribute_of(const std::string& element, const std::string& name) {
  const std::size_t start = element.find(" " + name + "=\"");
  if (start == std::string::npos) return "";
  const std::size_t from = start + name.size() + 3;
  return element.substr(from, element.find('"', from) - from);
}

}  // namespace

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("no file " + file.string());
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string VtkFile::attribute(const std::string& element, const std::string& name) const {
  const std::size_t start = text.find("<" + element + " ");
  if (start == std::string::npos) return "no " + element;
  return attribute_of(text.substr(start, text.find('>', start) - start), name);
}

VtkFile read_vtk(const std::filesystem::path& file) {
  VtkFile result;
  result.text = bytes_of(file);
  const std::string& text = result.text;
  for (std::size_t start = 0; (start = text.find("<DataArray ", start)) != std::string::npos;) {
    const std::size_t open = text.find('>', start), close = text.find("</DataArray>", open);
    const std::string element = text.substr(start, open - start);
    std::string body;
    for (const char c : text.substr(open + 1, close - open - 1))
      if (c != '\n') body += c;
    const std::string name = attribute_of(element, "Name"), type = attribute_of(element, "type");
    std::vector<double>& values = result.arrays[name];
    if (attribute_of(element, "format") == "ascii") {
      values.push_back(std::stod(body));
    } else {
      const std::string bytes = inflated(body);
      for (std::size_t i = 0; i < bytes.size(); i += 4)
        values.push_back(type == "Float32" ? static_cast<double>(at<float>(bytes, i)) : at<std::int32_t>(bytes, i));
      result.components[name] = std::stoi(attribute_of(element, "NumberOfComponents"));
    }
    start = close;
  }
  return result;
}

PlyFile read_ply(const std::filesystem::path& file) {
  const std::string bytes = bytes_of(file);
  const std::string end = "end_header\n";
  std::size_t offset = bytes.find(end) + end.size();
  std::istringstream header(bytes.substr(0, offset));
  std::size_t vertices = 0, faces = 0;
  std::vector<std::pair<std::string, std::string>> properties;  // name, type
  for (std::string line; std::getline(header, line);) {
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (first == "element" && second == "vertex") vertices = std::stoul(third);
    if (first == "element" && second == "face") faces = std::stoul(third);
    if (first == "property" && second != "list") properties.emplace_back(third, second);
  }
  PlyFile result;
  for (std::size_t v = 0; v < vertices; ++v)
    for (const auto& [name, type] : properties) {
      result.columns[name].push_back(type == "float" ? static_cast<double>(at<float>(bytes, offset)) : at<int>(bytes, offset));
      offset += 4;
    }
  for (std::size_t f = 0; f < faces; ++f) {
    if (bytes.at(offset) != 3) throw std::runtime_error("no triangle");
    result.faces.push_back({at<int>(bytes, offset + 1), at<int>(bytes, offset + 5), at<int>(bytes, offset + 9)});
    offset += 13;
  }
  if (offset != bytes.size()) throw std::runtime_error("the file is longer than its header says");
  return result;
}

ObjFile read_obj(const std::filesystem::path& file) {
  ObjFile result;
  std::istringstream text(bytes_of(file));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first == "o") words >> result.objects.emplace_back();
    if (first == "v") {
      auto& p = result.points.emplace_back();
      words >> p[0] >> p[1] >> p[2];
    }
    if (first == "f") {
      auto& f = result.faces.emplace_back();
      words >> f[0] >> f[1] >> f[2];
      for (int& corner : f) --corner;
    }
  }
  return result;
}

NpyFile read_npy_file(const std::filesystem::path& file) {
  const std::string bytes = bytes_of(file);
  const std::size_t data = 10 + at<std::uint16_t>(bytes, 8);
  const std::string header = bytes.substr(10, data - 10);
  NpyFile result;
  const std::size_t open = header.find('(');
  std::istringstream shape(header.substr(open + 1, header.find(')') - open - 1));
  for (std::string extent; std::getline(shape, extent, ',');)
    if (extent.find_first_not_of(' ') != std::string::npos) result.shape.push_back(std::stoul(extent));
  const bool whole = header.find("'<i4'") != std::string::npos;
  for (std::size_t i = data; i < bytes.size(); i += 4)
    result.values.push_back(whole ? at<std::int32_t>(bytes, i) : static_cast<double>(at<float>(bytes, i)));
  return result;
}

double volume_of(const std::vector<std::array<double, 3>>& points, const std::vector<std::array<int, 3>>& faces) {
  double volume = 0;
  for (const auto& f : faces) {
    const auto &a = points[static_cast<std::size_t>(f[0])], &b = points[static_cast<std::size_t>(f[1])],
               &c = points[static_cast<std::size_t>(f[2])];
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
  }
  return volume;
}

bool is_watertight(const std::vector<std::array<int, 3>>& faces) {
  std::map<std::pair<int, int>, int> uses;
  for (const auto& f : faces)
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = f[i], to = f[(i + 1) % 3];
      uses[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
    }
  for (const auto& [edge, balance] : uses)
    if (balance != 0) return false;
  return !faces.empty();
}

}  // namespace firn::test
