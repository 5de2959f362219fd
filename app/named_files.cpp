#include "app/named_files.h"

#include <fmt/format.h>

#include <filesystem>

namespace firn::app {

std::vector<NamedFile> read_named_files(const std::vector<std::string>& words, const std::string& option, const std::string& what,
                                        config::Diagnostics& diagnostics) {
  std::vector<NamedFile> files;
  for (const std::string& word : words) {
    const config::Place place{option + " " + word, 0, 0};
    const auto sign = word.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == word.size())
      diagnostics.error(place, fmt::format("expected {}=FILE.npy, such as position=positions.npy", what));
    else
      files.push_back({word.substr(0, sign), word.substr(sign + 1), place});
  }
  return files;
}

void check_folders(const std::vector<NamedFile>& files, config::Diagnostics& diagnostics) {
  for (const NamedFile& file : files)
    if (const std::filesystem::path folder = std::filesystem::path(file.file).parent_path();
        !folder.empty() && !std::filesystem::is_directory(folder))
      diagnostics.error(file.place, fmt::format("there is no folder '{}'", folder.string()));
}

}  // namespace firn::app
