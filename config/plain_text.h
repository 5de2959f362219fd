#pragma once

#include <string_view>

namespace firn::config {

// Whether YAML reads this as one text without quotes, in block style on one line. What it does not is no number and no boolean
// either.
bool can_be_plain(std::string_view text);

}  // namespace firn::config
