#include "app/usage_errors.h"

#include <fmt/format.h>

#include <vector>

#include "config/nearest.h"

namespace firn::app {
namespace {

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

}  // namespace

std::string usage_error(const CLI::App& program, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = program.remaining(true);
  const std::vector<CLI::App*> verbs = program.get_subcommands();
  const std::string name = verbs.empty() ? "firn" : "firn " + verbs.front()->get_name();
  std::vector<std::string> options = option_names(program);
  if (!verbs.empty())
    for (std::string& option : option_names(*verbs.front())) options.push_back(std::move(option));
  std::string text;
  // Words after an unknown option may be its value: only where there is none, they are told.
  for (const std::string& word : unknown)
    if (word.size() > 1 && word.starts_with('-')) {
      const std::string option = word.substr(0, word.find('='));
      text += fmt::format("{}: no option '{}'{}\n", name, option, config::suggestion(option, options));
    }
  if (text.empty() && !unknown.empty() && verbs.empty()) {
    std::vector<std::string> all;
    for (const CLI::App* verb : program.get_subcommands([](const CLI::App*) { return true; })) all.push_back(verb->get_name());
    return fmt::format("no verb '{}'{}\n", unknown.front(), config::suggestion(unknown.front(), all));
  }
  if (text.empty())
    for (const std::string& word : unknown) text += fmt::format("{}: '{}' is one word too many\n", name, word);
  if (text.empty()) text = fmt::format("{}: {}\n", name, error.what());
  return text + fmt::format("{} --help tells what there is\n", name);
}

}  // namespace firn::app
