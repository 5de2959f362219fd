#include "stages/vtk_files.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <stdexcept>

namespace firn::stages::vtk {
namespace {

void append_base64(std::string& text, std::span<const std::byte> bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto at = [&](std::size_t i) { return i < bytes.size() ? static_cast<std::uint32_t>(bytes[i]) : 0u; };
  text.reserve(text.size() + (bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::uint32_t group = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
    for (const int shift : {18, 12, 6, 0}) text += digits[group >> shift & 63];
  }
  if (const std::size_t rest = bytes.size() % 3; rest > 0) std::fill(text.end() - static_cast<long>(3 - rest), text.end(), '=');
}

// Blocks of 1 MiB, each compressed alone. Before them, encoded by itself: their number, their length, the length of a last one
// that is shorter (0: none is), their compressed lengths.
std::string encoded(std::span<const std::byte> bytes, int level) {
  constexpr std::size_t block = 1 << 20;
  std::vector<std::uint32_t> header{static_cast<std::uint32_t>((bytes.size() + block - 1) / block), block,
                                    static_cast<std::uint32_t>(bytes.size() % block)};
  std::vector<std::byte> packed;
  for (std::size_t begin = 0; begin < bytes.size(); begin += block) {
    const std::span<const std::byte> part = bytes.subspan(begin, std::min(block, bytes.size() - begin));
    const std::size_t before = packed.size();
    uLongf length = compressBound(part.size());
    packed.resize(before + length);
    if (compress2(reinterpret_cast<Bytef*>(packed.data() + before), &length, reinterpret_cast<const Bytef*>(part.data()),
                  part.size(), level) != Z_OK)
      throw std::runtime_error("zlib cannot compress");
    packed.resize(before + length);
    header.push_back(static_cast<std::uint32_t>(length));
  }
  std::string text;
  append_base64(text, std::as_bytes(std::span(header)));
  append_base64(text, packed);
  return text;
}

void append(std::string& text, const Array& array) {
  text += fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n", array.type, array.name,
                      array.components);
  text += array.text;
  text += "\n</DataArray>\n";
}

void append(std::string& text, const char* element, std::span<const Array> arrays) {
  text += fmt::format("<{}>\n", element);
  for (const Array& array : arrays) append(text, array);
  text += fmt::format("</{}>\n", element);
}

std::string start(const std::string& type, const std::string& geometry, double time) {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
      "compressor=\"vtkZLibDataCompressor\">\n<{0}{1}>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
      "NumberOfTuples=\"1\" format=\"ascii\">{2:.12g}</DataArray>\n</FieldData>\n",
      type, geometry, time);
}

Cells cells(const char* kind, std::span<const std::int32_t> connectivity, std::size_t count, std::int32_t corners, int level) {
  std::vector<std::int32_t> offsets(count);
  for (std::size_t i = 0; i < count; ++i) offsets[i] = static_cast<std::int32_t>(i + 1) * corners;
  return {kind, count, array("connectivity", 1, connectivity, level), array("offsets", 1, offsets, level)};
}

}  // namespace

Array array(std::string name, int components, std::span<const float> values, int level) {
  return {std::move(name), "Float32", components, encoded(std::as_bytes(values), level)};
}
Array array(std::string name, int components, std::span<const std::int32_t> values, int level) {
  return {std::move(name), "Int32", components, encoded(std::as_bytes(values), level)};
}

Cells one_per_point(std::size_t points, int level) {
  std::vector<std::int32_t> numbers(points);
  std::iota(numbers.begin(), numbers.end(), 0);
  return cells("Verts", numbers, points, 1, level);
}

Cells triangles(std::span<const std::array<int, 3>> corners, int level) {
  static_assert(sizeof(std::array<int, 3>) == 3 * sizeof(std::int32_t));
  const std::span numbers(reinterpret_cast<const std::int32_t*>(corners.data()), corners.size() * 3);
  return cells("Polys", numbers, corners.size(), 3, level);
}

std::string to_text(const PolyData& data, double time) {
  std::string text = start("PolyData", "", time);
  text += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOf{}=\"{}\">\n", data.points_count, data.cells.kind, data.cells.count);
  append(text, "PointData", data.point_data);
  append(text, "CellData", data.cell_data);
  append(text, "Points", {&data.points, 1});
  text += fmt::format("<{}>\n", data.cells.kind);
  append(text, data.cells.connectivity);
  append(text, data.cells.offsets);
  text += fmt::format("</{}>\n</Piece>\n</PolyData>\n</VTKFile>\n", data.cells.kind);
  return text;
}

std::string to_text(const Image& image, double time) {
  const auto& [a, b] = std::pair(image.first, image.last);
  const std::string extent = fmt::format("{} {} {} {} {} {}", a[0], b[0], a[1], b[1], a[2], b[2]);
  const auto three = [](const std::array<double, 3>& v) { return fmt::format("{} {} {}", v[0], v[1], v[2]); };
  const std::string geometry =
      fmt::format(" WholeExtent=\"{}\" Origin=\"{}\" Spacing=\"{}\"", extent, three(image.origin), three(image.spacing));
  std::string text = start("ImageData", geometry, time);
  text += fmt::format("<Piece Extent=\"{}\">\n", extent);
  append(text, "PointData", image.point_data);
  text += "</Piece>\n</ImageData>\n</VTKFile>\n";
  return text;
}

}  // namespace firn::stages::vtk
