#pragma once

// Where compiled programs are kept between runs.

#include <filesystem>

namespace firn::app {

// FIRN_CACHE names the folder, or says `off`; else $XDG_CACHE_HOME/firn, else ~/.cache/firn. Empty: nothing is kept.
std::filesystem::path program_cache_folder();

}  // namespace firn::app
