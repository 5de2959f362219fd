#include "app/choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "config/nearest.h"

namespace firn::app {

CLI::Validator one_of(const std::vector<std::string>& choices) {
  const auto check = [choices](const std::string& word) -> std::string {
    if (std::ranges::find(choices, word) != choices.end()) return "";
    const auto nearest = config::nearest(word, choices);
    return fmt::format("cannot be '{}'{} valid: {}", word, nearest ? fmt::format("; did you mean '{}'?", *nearest) : ";",
                       fmt::join(choices, ", "));
  };
  return {check, fmt::format("{{{}}}", fmt::join(choices, ","))};
}

CLI::Validator at_least(double least) {
  return {[least](const std::string& word) -> std::string {
            double value = 0;
            if (CLI::detail::lexical_cast(word, value) && value >= least) return "";
            return fmt::format("must be a number from {}, not '{}'", least, word);
          },
          ""};
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::vector<std::string> choices;
  for (std::size_t at = begin + 1; at < end;) {
    const std::size_t comma = std::min(type.find(',', at), end);
    choices.push_back(type.substr(at, comma - at));
    at = comma + 1;
  }
  return choices;
}

}  // namespace firn::app
