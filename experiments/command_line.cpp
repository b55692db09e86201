#include "experiments/command_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>

#include "core/error.h"
#include "core/version.h"
#include "experiments/menu.h"
#include "experiments/message.h"

namespace halfslope {
namespace {

int parse_and_run(int argc, const char* const* argv, const Catalogue& catalogue) {
  CLI::App app{"halfslope: convergence analysis for Monte Carlo and quasi-Monte Carlo rendering", "halfslope"};
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  app.footer(
      "Environment: HALFSLOPE_ISA (scalar, baseline, avx2, avx512) chooses the kernels, HALFSLOPE_CACHE the folder of "
      "references, HALFSLOPE_KERNELS and HALFSLOPE_SCENES where kernels and shipped "
      "scenes' files are looked for first.\n"
      "Exit codes: 0 done, 1 a check failed or a cell is invalid, 2 usage, 3 bad input, 4 input/output, 130 "
      "interrupted.");

  std::vector<Command> commands;
  for (const auto add : {add_run, add_list, add_points, add_measure, add_render, add_reference, add_figure,
                         add_selfcheck, add_analyze, add_scenes, add_completion})
    commands.push_back(add(app));

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(command->get_name());
    std::string problem = error.what();
    if (argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty()) {
      problem = fmt::format("there is no command '{}'{}", argv[1], did_you_mean(argv[1], names));
    }
    message("halfslope: {}\nTry `halfslope {}--help`.\n", problem,
            app.get_subcommands().empty() ? "" : app.get_subcommands().front()->get_name() + " ");
    return static_cast<int>(ExitCode::kUsage);
  }
  const auto chosen = std::ranges::find_if(commands, [](const Command& command) { return command.app->parsed(); });
  return chosen->run(catalogue);
}

// The number of a closed standard stream would go to the next file that is opened, and text meant for the stream into
// that file. What is opened here instead refuses it, as a closed stream does.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) < 0) ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace

int command_line(int argc, const char* const* argv, const Catalogue& catalogue) {
  occupy_closed_streams();
  int code = static_cast<int>(ExitCode::kIo);
  try {
    code = parse_and_run(argc, argv, catalogue);
  } catch (const Error& error) {
    message("halfslope: {}\n", error.what());
    code = static_cast<int>(error.code());
  } catch (const std::bad_alloc&) {
    message("halfslope: out of memory; ask for fewer points, pixels or replicates\n");
  } catch (const std::exception& error) {
    message("halfslope: {}\n", error.what());
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    message("halfslope: standard output could not be written\n");
    code = code == 0 ? static_cast<int>(ExitCode::kIo) : code;
  }
  return code;
}

}  // namespace halfslope
