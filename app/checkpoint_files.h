#pragma once

// The files of one checkpoint, and that they are as they were written.

#include <filesystem>
#include <map>
#include <string>

namespace firn::app {

inline constexpr const char* hash_list = "SHA256SUMS";  // of all other files, as the program sha256sum writes and checks it
inline constexpr const char* checkpoint_manifest = "manifest.json";

// "position.npy.zst"; characters that do not belong into a file's name as %NN.
std::string array_file(const std::string& buffer);

std::string hash_lines(const std::map<std::string, std::string>& hashes);  // by file

// Throws std::runtime_error, naming the file, where one is missing, is not as listed, or is there but not listed.
void verify_files(const std::filesystem::path& folder);

}  // namespace firn::app
