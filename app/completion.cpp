// Scripts that let shells complete the words of the command, generated from the program's own verbs and options.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "app/choice.h"
#include "app/shipped.h"
#include "app/verbs.h"
#include "stages/register.h"

namespace firn::app {
namespace {

// One option or positional of a verb.
struct Argument {
  std::vector<std::string> names;  // "--steps", "-R"; of a positional: empty
  std::string doc;
  bool takes_value = false;
  std::vector<std::string> values;  // what it may be; files besides, where `files`
  bool files = false;
};
struct Verb {
  std::string name, doc;
  std::vector<Argument> arguments;
};

Argument argument(const CLI::Option& option) {
  Argument result;
  for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
  result.doc = option.get_description();
  result.takes_value = option.get_items_expected_max() > 0;
  result.values = choices_of(option);
  if (!result.values.empty() || !result.takes_value) return result;
  // Of what a value is, its name tells.
  const std::string name = result.names.empty() ? option.get_name(true) : result.names.front();
  if (name == "PIPELINE" || name == "A" || name == "B") result.values = shipped_pipelines();
  if (name == "--scene") result.values = shipped_scenes();
  if (name == "STAGE" || name == "--disable") result.values = stages::all_stages(nullptr).names();
  constexpr std::string_view of_files[] = {"PIPELINE", "A", "B", "STAGE", "--scene", "--out", "--dump", "--in"};
  result.files = std::ranges::find(of_files, name) != std::end(of_files);
  return result;
}

std::vector<Argument> arguments(const CLI::App& app) {
  std::vector<Argument> list;
  for (const CLI::Option* option : app.get_options()) list.push_back(argument(*option));
  return list;
}

std::vector<Verb> verbs_of(const CLI::App& program) {
  std::vector<Verb> verbs;
  const std::vector<Argument> shared = arguments(program);
  for (const CLI::App* app : program.get_subcommands([](const CLI::App*) { return true; })) {
    Verb verb{app->get_name(), app->get_description(), arguments(*app)};
    for (const Argument& one : shared) {
      const auto taken = [&](const Argument& other) { return !one.names.empty() && other.names == one.names; };
      if (std::ranges::none_of(verb.arguments, taken)) verb.arguments.push_back(one);
    }
    verbs.push_back(std::move(verb));
  }
  return verbs;
}

// As one word of a shell.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string offer(const Argument& argument) {
  if (!argument.files && argument.values.empty()) return ":";
  return fmt::format("COMPREPLY=($(compgen {}-W {} -- \"$word\"))", argument.files ? "-f " : "",
                     quoted(fmt::format("{}", fmt::join(argument.values, " "))));
}

std::string for_bash(const std::vector<Verb>& verbs) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs) names.push_back(verb.name);
  std::string text = R"(_firn() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb= i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    [[ ${COMP_WORDS[i]} == -* ]] || { verb=${COMP_WORDS[i]}; break; }
  done
)";
  text += fmt::format("  [[ -n $verb ]] || {{ COMPREPLY=($(compgen -W {} -- \"$word\")); return; }}\n  case $verb in\n",
                      quoted(fmt::format("{} --help --version", fmt::join(names, " "))));
  for (const Verb& verb : verbs) {
    text += fmt::format("    {})\n      case $before in\n", verb.name);
    std::vector<std::string> options;
    Argument positional;
    for (const Argument& one : verb.arguments) {
      options.insert(options.end(), one.names.begin(), one.names.end());
      if (one.takes_value && !one.names.empty())
        text += fmt::format("        {}) {}; return ;;\n", fmt::join(one.names, "|"), offer(one));
      if (one.names.empty()) positional = one;
    }
    text += fmt::format(
        "      esac\n      if [[ $word == -* ]]; then COMPREPLY=($(compgen -W {} -- \"$word\")); else {}; fi\n      ;;\n",
        quoted(fmt::format("{}", fmt::join(options, " "))), offer(positional));
  }
  return text + "  esac\n}\ncomplete -o filenames -F _firn firn ./firn\n";
}

std::string for_zsh(const std::vector<Verb>& verbs) {
  // A file in $fpath is read when the first words are to be completed, which then are still to be.
  return "#compdef firn\nautoload -U +X bashcompinit && bashcompinit\n" + for_bash(verbs) +
         "if [[ ${zsh_eval_context[-1]} == loadautofunc ]]; then _bash_complete -o filenames -F _firn; fi\n";
}

std::string for_fish(const std::vector<Verb>& verbs) {
  // Fish takes both a backslash and a quote after a backslash.
  const auto fish_quoted = [](const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return result + "'";
  };
  std::string text = "complete -c firn -f\n";
  for (const Verb& verb : verbs) {
    text += fmt::format("complete -c firn -n __fish_use_subcommand -a {} -d {}\n", verb.name, fish_quoted(verb.doc));
    const std::string here = fmt::format("complete -c firn -n {}", fish_quoted("__fish_seen_subcommand_from " + verb.name));
    for (const Argument& one : verb.arguments) {
      std::string line = here;
      for (const std::string& name : one.names) line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (!one.doc.empty() && !one.names.empty()) line += " -d " + fish_quoted(one.doc);
      if (one.takes_value && !one.names.empty()) line += one.files ? " -r" : " -x";
      if (one.files) line += " -F";
      if (!one.values.empty()) line += " -a " + fish_quoted(fmt::format("{}", fmt::join(one.values, " ")));
      if (line != here) text += line + "\n";
    }
  }
  return text;
}

}  // namespace

void add_completion(CLI::App& program, Action& action) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* verb = program.add_subcommand("completion", "A script with which a shell completes the words of this command");
  verb->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(one_of({"bash", "zsh", "fish"}));
  verb->footer(
      "bash: source <(firn completion bash)\nzsh: firn completion zsh > a file _firn in $fpath\nfish: firn completion fish | "
      "source");
  verb->callback([&program, &action, shell] {
    action = [&program, shell] {
      const std::vector<Verb> verbs = verbs_of(program);
      fmt::print("{}", *shell == "bash" ? for_bash(verbs) : *shell == "zsh" ? for_zsh(verbs) : for_fish(verbs));
      return static_cast<int>(Status::done);
    };
  });
}

}  // namespace firn::app
