#pragma once

#include "samplers/catalogue.h"

namespace halfslope {

/// Adds the families file:PATH, file-wrap:PATH and file-clamp:PATH: the points of a file (samplers/point_file.h), whose
/// sets are the replicates. A file is read once for a catalogue and its copies, whatever becomes of it meanwhile.
void add_file_points(SamplerCatalogue& catalogue);

}  // namespace halfslope
