#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "samplers/sampler.h"

namespace halfslope {

/// The extensible rank-1 lattice of R. Cools, F. Y. Kuo and D. Nuyens: i ↦ φ_2(i) z modulo 1, shifted at random.
std::unique_ptr<Sampler> make_lattice();

/// The same, each coordinate then folded by the tent 1 − |2x − 1|, which lets smooth integrands that are not periodic
/// gain a second order.
std::unique_ptr<Sampler> make_lattice_tent();

/// The generating vector z of 250 dimensions, for up to 2²⁰ points.
std::span<const std::uint32_t> lattice_vector();

}  // namespace halfslope
