#pragma once

#include "experiments/catalogue.h"

namespace halfslope {

/// The program: parses the arguments, runs the command, prints errors to stderr, and returns the exit code
/// (core/error.h). An embedder adds to the catalogue first.
int command_line(int argc, const char* const* argv, const Catalogue& catalogue);

}  // namespace halfslope
