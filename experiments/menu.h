// The commands' flags, as CLI11 reads them.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>

#include "experiments/catalogue.h"

namespace halfslope {

/// A command of the program, and what it does with its flags once they are read; that returns the exit code.
struct Command {
  CLI::App* app;
  std::function<int(const Catalogue& catalogue)> run;
};

Command add_run(CLI::App& app);
Command add_list(CLI::App& app);
Command add_points(CLI::App& app);
Command add_measure(CLI::App& app);
Command add_render(CLI::App& app);
Command add_reference(CLI::App& app);
Command add_figure(CLI::App& app);
Command add_selfcheck(CLI::App& app);
Command add_analyze(CLI::App& app);
Command add_scenes(CLI::App& app);
Command add_completion(CLI::App& app);

/// Flags that several commands have.
void add_seed(CLI::App& command, std::uint64_t& seed);
void add_threads(CLI::App& command, int& threads, const std::string& help);
/// Refuses what is no whole number from 0 to 2^64 - 1: converted, it would silently become another one.
const CLI::Validator& whole_number();

}  // namespace halfslope
