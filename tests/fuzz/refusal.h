#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

namespace firn::fuzz {

// Input errors, and sentences of the readers; not errors of the system or of a library that nobody has put into words.
template <typename Read>
void read_or_refuse(const std::filesystem::path& file, Read read) {
  try {
    read();
  } catch (const std::system_error&) {
    throw;
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    if (text.find(file.filename().string()) == std::string::npos)
      throw std::logic_error("a refusal that does not name its file: " + text);
    if (text.size() > 10000) throw std::logic_error("a refusal of " + std::to_string(text.size()) + " bytes");
  }
}

}  // namespace firn::fuzz
