#pragma once

// Inside gpu/ only.

#include <string>
#include <string_view>
#include <vector>

namespace firn::gpu {

// How a line begins that tells file and line of the next; see ShaderSource.
inline constexpr std::string_view line_directive = "#line ";

// The lines of `text`, without their ends.
std::vector<std::string_view> lines_of(std::string_view text);

// The text with its #line directives made comments of the same length, so that a driver counts the lines of the whole text.
std::string with_plain_lines(std::string_view text);

}  // namespace firn::gpu
