#pragma once

#include <string>

namespace halfslope {

/// "0.1.0"
std::string version();
/// The compiler that built this program, with its version.
std::string compiler();

}  // namespace halfslope
