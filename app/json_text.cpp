#include "app/json_text.h"

namespace firn::app {

using nlohmann::json;

json parse_json(std::string_view text) {
  constexpr int deepest = 100;
  struct TooDeep {};
  try {
    return json::parse(
        text,
        [](int depth, json::parse_event_t, const json&) {
          if (depth > deepest) throw TooDeep{};
          return true;
        },
        false);
  } catch (const TooDeep&) {
    return {json::value_t::discarded};
  }
}

}  // namespace firn::app
