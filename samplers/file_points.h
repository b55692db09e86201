#pragma once

#include <string>
#include <string_view>

#include "samplers/catalogue.h"

namespace halfslope {

/// Adds the families file:PATH, file-wrap:PATH and file-clamp:PATH: the points of a file (samplers/point_file.h), whose
/// sets are the replicates. A file is read once for a catalogue and its copies, whatever becomes of it meanwhile.
void add_file_points(SamplerCatalogue& catalogue);

/// The path in the name of a sampler of these families; empty for any other name. What is wrong with such a sampler is
/// wrong with its file.
std::string point_file_of(std::string_view sampler);

}  // namespace halfslope
