#include <fmt/format.h>

#include "app/explain.h"

namespace firn::app {

nlohmann::json forms_as_json(const FormsOfPlan& forms) {
  nlohmann::json choices = nlohmann::json::array();
  for (const graph::AutomaticChoice& choice : forms.choices)
    choices.push_back(
        {{"stage", choice.stage}, {"parameter", choice.parameter}, {"value", choice.value}, {"automatic", choice.chosen}});
  return {{"device", forms.device.name}, {"assumed", forms.device.assumed}, {"reason", forms.reason}, {"choices", choices}};
}

std::string forms_as_text(const FormsOfPlan& forms) {
  if (forms.choices.empty()) return "";
  std::string text = fmt::format("\nforms of kernels for {}{}\n  {}\n", forms.device.name,
                                 forms.device.assumed ? " (assumed; --device names another one)" : "", forms.reason);
  for (const graph::AutomaticChoice& choice : forms.choices)
    text += fmt::format("  {:<28} {:<26} {}\n", choice.stage, choice.parameter + ": " + choice.value,
                        choice.chosen ? "chosen by auto" : "as the pipeline says");
  return text;
}

}  // namespace firn::app
