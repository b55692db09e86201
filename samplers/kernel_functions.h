// The kernels themselves, inside one instruction set's library.
#pragma once

#include "samplers/kernels.h"

namespace halfslope::kernel {

void random_words(const WordStream& stream, std::uint32_t draw, std::uint32_t dim, std::uint32_t begin, int count,
                  int shift, std::uint32_t* out);
void halton_owen(const HaltonDim& dim, std::uint32_t begin, int count, std::uint32_t* high, std::uint32_t* low);
void halton_owen_table(std::uint32_t base, const std::uint32_t* keys, std::uint32_t count, double* out);

}  // namespace halfslope::kernel
