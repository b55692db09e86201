#include <memory>

#include "experiments/commands.h"
#include "experiments/menu.h"

namespace halfslope {

Command add_scenes(CLI::App& app) {
  const auto kept = std::make_shared<ScenesCheckArguments>();
  CLI::App* scenes = app.add_subcommand("scenes", "look at scene files");
  scenes->require_subcommand(1);
  CLI::App* command = scenes->add_subcommand(
      "check", "what scenes hold, what of them is understood, and which work they let us skip; every problem of each");
  command
      ->add_option("files", kept->files,
                   "Mitsuba .xml files, with FILE.xml:name=value,... for their <default>s, or names of shipped scenes")
      ->required()
      ->type_name("FILE");
  command->add_flag("--json", kept->json, "as JSON");
  return {scenes, [kept](const Catalogue&) { return scenes_check_command(*kept); }};
}

}  // namespace halfslope
