#pragma once

#include <memory>
#include <string>

#include "samplers/catalogue.h"

namespace halfslope {

/// What `halfslope list` says of the family padded:NAME.
SamplerInfo padded_family_info();

/// The first two dimensions of the sampler `name` of the catalogue, held in memory and padded (samplers/padded.h).
/// Error(kBadInput) if there is none of that name, or it has fewer than two dimensions.
std::unique_ptr<Sampler> make_padded(const std::string& name, const SamplerCatalogue& catalogue);

}  // namespace halfslope
