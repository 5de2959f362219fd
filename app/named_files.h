#pragma once

// Words of the command line that name something and a file for it: position=positions.npy.

#include <string>
#include <vector>

#include "config/diagnostics.h"

namespace firn::app {

struct NamedFile {
  std::string name, file;
  config::Place place;  // "--dump position=positions.npy"
};

// Reads such words of `option`; malformed ones are errors. `what` is what the name stands for, in capitals ("BUFFER").
std::vector<NamedFile> read_named_files(const std::vector<std::string>& words, const std::string& option, const std::string& what,
                                        config::Diagnostics& diagnostics);

// Folders of files to be written must be there: told now, not after hours of simulation.
void check_folders(const std::vector<NamedFile>& files, config::Diagnostics& diagnostics);

}  // namespace firn::app
