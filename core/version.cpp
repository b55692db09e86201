#include "core/version.h"

namespace halfslope {

std::string version() { return HALFSLOPE_VERSION; }
std::string compiler() { return HALFSLOPE_COMPILER; }

}  // namespace halfslope
