#pragma once

#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// The Hammersley set of N = 2^m points under nested scrambling: i/N in base 2, then the scrambled Halton sequence. Its
/// first two dimensions are a scrambled (0, m, 2)-net.
std::unique_ptr<Sampler> make_hammersley_owen();

}  // namespace halfslope
