#pragma once

#include <cstdint>
#include <memory>

#include "samplers/sampler.h"

namespace halfslope {

/// Progressive multi-jittered (0, 2) pairs: a sequence of which every aligned run of 2^m points is a (0, m, 2)-net in
/// base 2, each square of side 2^−k holds one of the first 4^k points, and the point 4^k places further on lies in the
/// same square, diagonally opposite.
std::unique_ptr<Sampler> make_pmj02();

/// Of the point `index` > 0, the point that shares its first k digits of the coordinate (0: x, 1: y), where k is the
/// place of the highest 1 of `index`, and differs in digit k. It is below 2^k.
std::uint32_t pmj02_parent(int coordinate, std::uint32_t index);

}  // namespace halfslope
