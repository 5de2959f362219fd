#pragma once

// SHA-256, the one hash of this project, as 64 hexadecimal digits: what the program sha256sum prints.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace firn::app {

std::string sha256(std::span<const std::byte> bytes);
std::string sha256(std::string_view text);

// Of a regular file, read in pieces. Throws std::runtime_error that names the file.
std::string sha256_of(const std::filesystem::path& file);

}  // namespace firn::app
