#pragma once

// NumPy's .npy files: one array each. Read: format versions 1 to 3, C order, little endian, float32, float64, int32, uint32.
// Written: version 1 of the same kinds. Every failure is a std::runtime_error with a sentence that names the file.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace firn::scene {

enum class NpyKind { float32, float64, int32, uint32 };
std::string to_string(NpyKind kind);  // "float32"

using NpyShape = std::vector<std::uint64_t>;
std::string to_string(const NpyShape& shape);  // "(100, 3)"

struct NpyHeader {
  NpyKind kind = NpyKind::float64;
  NpyShape shape;                 // empty: a single number
  std::uint64_t count = 1;        // product of the shape
  std::uint64_t data_offset = 0;  // bytes before the first value
};

struct NpyArray {
  NpyKind kind = NpyKind::float64;  // as in the file
  NpyShape shape;
  std::vector<double> values;  // C order: the last index runs fastest. Every kind fits a double exactly.
};

// `name` stands for the file in error texts.
NpyHeader parse_npy_header(std::string_view bytes, const std::string& name);
NpyArray parse_npy(std::string_view bytes, const std::string& name);

// The header alone, without reading the values; the file must be as long as the header says.
NpyHeader read_npy_header(const std::filesystem::path& file);
NpyArray read_npy(const std::filesystem::path& file);

// What stands before the values of an array: version 1, a multiple of 64 bytes.
std::string npy_header(NpyKind kind, const NpyShape& shape);

// `values` holds as many values as the shape says. An existing file is replaced; where the disk is full there is none.
void write_npy(const std::filesystem::path& file, const NpyShape& shape, std::span<const float> values);
void write_npy(const std::filesystem::path& file, const NpyShape& shape, std::span<const double> values);
void write_npy(const std::filesystem::path& file, const NpyShape& shape, std::span<const std::int32_t> values);
void write_npy(const std::filesystem::path& file, const NpyShape& shape, std::span<const std::uint32_t> values);

}  // namespace firn::scene
