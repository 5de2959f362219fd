#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace firn::app {

// Discarded (is_discarded()) where the text is no JSON, or nested deeper than anything that Firn writes: whatever looks at values
// calls itself for those within.
nlohmann::json parse_json(std::string_view text);

}  // namespace firn::app
