#include <fmt/format.h>

#include "experiments/menu.h"

namespace halfslope {
namespace {

/// " --flag --other", and the same of what the command is followed by.
std::string completion_words(const CLI::App& command) {
  std::string words;
  for (const CLI::Option* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) {
      if (name != "help") words += " --" + name;
    }
  }
  for (const CLI::App* next : command.get_subcommands([](const CLI::App*) { return true; }))
    words += " " + next->get_name() + completion_words(*next);
  return words;
}

// Every command and its flags, for the shell.
std::string bash_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    const std::string flags = "--help" + completion_words(*command);
    commands += (commands.empty() ? "" : " ") + command->get_name();
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), flags);
  }
  return "_halfslope() {\n  local current=\"${COMP_WORDS[COMP_CWORD]}\" previous=\"${COMP_WORDS[COMP_CWORD-1]}\" "
         "words\n"
         "  case \"$previous\" in\n"
         "    --sampler|--samplers) words=\"$(halfslope list samplers --names)\" ;;\n"
         "    --scene) words=\"$(halfslope list scenes --names)\" ;;\n"
         "    --measures) words=\"$(halfslope list measures --names) none\" ;;\n"
         "    figure) words=\"$(halfslope list figures --names)\" ;;\n"
         "    selfcheck) words=\"coverage\" ;;\n"
         "    list) words=\"samplers estimators scenes measures metrics figures statuses\" ;;\n"
         "    *) case \"${COMP_WORDS[1]}\" in\n" +
         cases + "    *) words=\"" + commands +
         "\" ;;\n    esac ;;\n  esac\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\") $(compgen -f -- \"$current\"))\n}\n"
         "complete -o filenames -F _halfslope halfslope\n";
}

}  // namespace

Command add_completion(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("completion", "print a bash completion script: source <(halfslope completion)");
  return {command, [&app](const Catalogue&) {
            fmt::print("{}", bash_completion(app));
            return 0;
          }};
}

}  // namespace halfslope
