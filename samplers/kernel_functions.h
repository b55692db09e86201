// The kernels themselves, inside one instruction set's library.
#pragma once

#include "samplers/kernels.h"

namespace halfslope::kernel {

void random_words(const WordStream& stream, std::uint32_t draw, std::uint32_t dim, std::uint32_t begin, int count,
                  int shift, std::uint32_t* out);
void halton_owen(const HaltonDim& dim, const std::uint32_t* indices, int count, std::uint32_t* high,
                 std::uint32_t* low);
void halton_owen_table(std::uint32_t base, const std::uint32_t* keys, std::uint32_t count, double* out);
void sobol_owen(const SobolRun& run, const OwenTree& tree, int count, std::uint32_t* high);
void sobol_owen_table(const std::uint32_t* keys, std::uint32_t digits, std::uint32_t* out);
void sobol_owen_fast(const SobolRun& run, const std::uint32_t* keys, int count, std::uint32_t* high);

}  // namespace halfslope::kernel
