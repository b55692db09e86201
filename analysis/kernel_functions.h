// The kernels themselves, inside one instruction set's library.
#pragma once

#include "analysis/kernels.h"

namespace halfslope::kernel {

PairSum pair_products(const PairProducts& points, std::size_t i_begin, std::size_t i_end, std::size_t j_begin,
                      std::size_t j_end);

}  // namespace halfslope::kernel
